"""Any picture as a mat: every kind of file, every way to fit it, and a clear word for what cannot serve."""

from __future__ import annotations

import io
import os
import struct
import subprocess
import sys
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.cases import cases, for_rows
from tests.conftest import Command
from tuisim.base.errors import BackgroundError
from tuisim.engine import mat_cache, mat_image
from tuisim.engine.core.spec import BACKGROUND_FITS

WIDTH = 2362
HEIGHT = 1143
WHITE = [255, 255, 255]


def saved(image: Image.Image, kind: str = "PNG", **options: object) -> bytes:
    stream = io.BytesIO()
    image.save(stream, kind, **options)
    return stream.getvalue()


def decoded(content: bytes, fit: str = "centre") -> np.ndarray:
    return mat_image.decode(content, Path("mat.png"), fit)


def middle(field: np.ndarray) -> list[int]:
    """The colour in the middle of the field."""
    shown: list[int] = field[HEIGHT // 2, WIDTH // 2].tolist()
    return shown


def png(width: int, height: int, *, depth: int = 8, color: int = 2, data: bytes = b"") -> bytes:
    """A PNG file whose header says whatever it is told."""

    def chunk(name: bytes, body: bytes) -> bytes:
        return (
            struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
        )

    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(data))
        + chunk(b"IEND", b"")
    )


def a_folder(path: Path) -> None:
    path.mkdir()


def a_loop(path: Path) -> None:
    path.symlink_to(path.name)


def a_pipe(path: Path) -> None:
    os.mkfifo(path)


def holding(content: bytes) -> Callable[[Path], object]:
    return lambda path: path.write_bytes(content)


WHOLE = saved(Image.effect_noise((300, 200), 50).convert("RGB"))
PHOTO = saved(Image.effect_noise((300, 200), 50), "JPEG")
BOMB = png(60_000, 60_000)

BAD = [
    pytest.param(lambda path: None, "cannot be read: No such file", id="missing"),
    pytest.param(a_folder, "is a folder", id="folder"),
    pytest.param(a_loop, "Too many levels of symbolic links", id="symlink loop"),
    pytest.param(a_pipe, "is not a regular file", id="pipe"),
    pytest.param(holding(b""), "is empty", id="empty"),
    pytest.param(holding(b"hello"), "is not a readable image", id="text"),
    pytest.param(holding(bytes(range(256)) * 40), "is not a readable image", id="binary rubbish"),
    pytest.param(
        holding(b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 100 100\n%%EndComments\nshowpage\n"),
        "is PostScript, a program",
        id="PostScript",
    ),
    pytest.param(
        holding(b"\x89PNG\r\n\x1a\n" + bytes(40)), "is not a readable image", id="broken header"
    ),
    pytest.param(
        holding(WHOLE[: len(WHOLE) // 2]), "is a damaged image: .*truncated", id="truncated PNG"
    ),
    pytest.param(holding(WHOLE[:60]), "is a damaged image", id="hardly begun"),
    pytest.param(holding(PHOTO[: len(PHOTO) // 2]), "is a damaged image", id="truncated JPEG"),
    pytest.param(holding(png(0, 10)), "is not a readable image|has no pixels", id="no width"),
    pytest.param(holding(BOMB), "is too large.* 40", id="60,000 × 60,000"),
    pytest.param(
        holding(png(12_000, 10_000)),
        "12,000 × 10,000 pixels are 120 megapixels",
        id="120 megapixels",
    ),
    pytest.param(
        holding(png(40_001, 1000)), "40,001 × 1,000 .* the limit is 40", id="just too large"
    ),
    pytest.param(holding(png(50, 50, depth=3)), "is not a readable image", id="impossible depth"),
]


@pytest.mark.parametrize("make, message", BAD)
def test_a_bad_mat_image_is_refused_with_a_reason_and_leaves_no_cache_file(
    make: Callable[[Path], object], message: str, home: Path, tmp_path: Path
) -> None:
    make(tmp_path / "mat.png")
    with pytest.raises(BackgroundError, match=message) as caught:
        mat_cache.FieldFiles.prepare(tmp_path / "mat.png", [20])
    assert caught.value.file == str(tmp_path / "mat.png")
    assert "40 megapixels and 256 MB" in caught.value.hint
    assert not home.exists()


@pytest.mark.parametrize("make, message", BAD)
def test_the_command_refuses_bad_files_in_one_line(
    make: Callable[[Path], object], message: str, here: Command, home: Path, tmp_path: Path
) -> None:
    make(tmp_path / "mat.png")
    (tmp_path / "program.py").write_text("print(1)\n", encoding="utf-8")
    done = here("run", "program.py", "-b", "mat.png", "--export", "out.csv")
    assert (done.returncode, done.stdout) == (2, "")
    assert "mat.png" in done.stderr and "Traceback" not in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "out.csv").exists()


def test_a_decompression_bomb_is_refused_quickly_and_in_little_memory(
    tmp_path: Path, root: Path
) -> None:
    (tmp_path / "bomb.png").write_bytes(BOMB)
    code = (
        "import resource, sys\n"
        "from pathlib import Path\n"
        "from tuisim.engine import mat_cache as fields\n"
        "from tuisim.base.errors import BackgroundError\n"
        "try: fields.FieldFiles.prepare(Path(sys.argv[1]), [20])\n"
        "except BackgroundError as error: print(error.message)\n"
        "used = resource.getrusage(resource.RUSAGE_SELF)\n"
        # Linux passes the most that a process has used on to its children, but not through the status of their own.
        "status = Path('/proc/self/status')\n"
        "told = status.read_text().split('VmHWM:') if status.exists() else ['', str(used.ru_maxrss // 1024)]\n"
        "print(int(told[1].split()[0]) // 1024, used.ru_utime)\n"
    )
    command = [sys.executable, "-c", code, str(tmp_path / "bomb.png")]
    printed = subprocess.run(
        command, capture_output=True, text=True, check=True, cwd=root
    ).stdout.splitlines()
    megabytes, cpu_s = map(float, printed[1].split())
    assert "is too large" in printed[0]
    assert megabytes < 300 and cpu_s < 2


@pytest.fixture
def _a_nobody() -> Iterator[None]:
    """Without the rights of root, who may read everything."""
    mine = os.geteuid()
    if mine == 0:
        os.seteuid(65534)
    yield
    os.seteuid(mine)


@pytest.fixture
def locked(tmp_path: Path) -> Path:
    """A picture that nobody may read."""
    (tmp_path / "mat.png").write_bytes(WHOLE)
    (tmp_path / "mat.png").chmod(0)
    return tmp_path / "mat.png"


@pytest.mark.usefixtures("locked", "_a_nobody")
def test_an_image_without_read_permission_is_refused_with_the_reason(tmp_path: Path) -> None:
    with pytest.raises(BackgroundError, match="cannot be read: Permission denied"):
        mat_image.read_file(tmp_path / "mat.png")


def test_an_image_file_beyond_the_size_limit_is_refused(tmp_path: Path) -> None:
    with (tmp_path / "mat.tiff").open("wb") as stream:
        stream.truncate(257_000_000)
    with pytest.raises(BackgroundError, match="257 MB, the limit is 256"):
        mat_image.read_file(tmp_path / "mat.tiff")


@pytest.mark.parametrize("fit", ["", "Stretch", "tile"])
def test_an_unknown_fit_of_a_mat_image_is_refused_with_the_known_ones(
    fit: str, tmp_path: Path
) -> None:
    (tmp_path / "mat.png").write_bytes(WHOLE)
    with pytest.raises(BackgroundError, match="no such fit") as caught:
        mat_cache.FieldFiles.prepare(tmp_path / "mat.png", [20], fit)
    assert all(allowed in caught.value.hint for allowed in BACKGROUND_FITS)


def test_fit_stretch_makes_the_image_fill_the_field() -> None:
    image = Image.new("RGB", (40, 60), "red")
    image.paste("blue", (20, 0, 40, 60))
    field = decoded(saved(image), "stretch")
    assert field.shape == (HEIGHT, WIDTH, 3)
    assert field[0, 0].tolist() == field[-1, 1000].tolist() == [255, 0, 0]
    assert field[0, -1].tolist() == field[-1, 1400].tolist() == [0, 0, 255]


@pytest.mark.quick_cases("square")
@cases(
    "size, box",
    {
        "square": ((100, 100), (609, 0, 1752, 1143)),
        "wide": ((3000, 100), (0, 532, 2362, 611)),
        "high": ((50, 4000), (1174, 0, 1188, 1143)),
    },
)
def test_fit_fit_keeps_the_proportions_of_the_image(
    size: tuple[int, int], box: tuple[int, int, int, int]
) -> None:
    field = decoded(saved(Image.new("RGB", size, "black")), "fit")
    rows, columns = np.nonzero(~field.any(axis=2))
    assert (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1) == box
    assert len(rows) == (box[2] - box[0]) * (box[3] - box[1])
    assert (field[field.any(axis=2)] == 255).all()


@pytest.mark.slow_cases("size2-*")
@pytest.mark.parametrize(
    "size, dark", [((100, 50), 5000), ((3000, 50), WIDTH * 50), ((3000, 2000), WIDTH * HEIGHT)]
)
def test_fit_centre_copies_the_image_pixel_for_pixel(size: tuple[int, int], dark: int) -> None:
    image = Image.new("RGB", size, "black")
    image.putpixel((size[0] // 2, size[1] // 2), (9, 8, 7))
    field = decoded(saved(image), "centre")
    assert int((field < 10).all(axis=2).sum()) == dark
    assert middle(field) == [9, 8, 7]


@pytest.mark.slow
def test_a_mat_image_of_the_fields_size_is_not_scaled() -> None:
    image = Image.effect_noise((WIDTH, HEIGHT), 90).convert("RGB")
    content = saved(image, compress_level=1)
    for fit in BACKGROUND_FITS:
        assert np.array_equal(decoded(content, fit), np.asarray(image)), fit


@pytest.mark.quick_cases("black-*", "white-PNG-*")
@pytest.mark.parametrize(
    "kind, mode",
    [
        *(("PNG", mode) for mode in ("1", "L", "LA", "P", "RGB", "RGBA")),
        *(("TIFF", mode) for mode in ("1", "L", "P", "RGB", "RGBA", "CMYK", "YCbCr", "LAB")),
        *(("JPEG", mode) for mode in ("L", "RGB", "CMYK", "YCbCr")),
        *(("GIF", mode) for mode in ("1", "L", "P", "RGB")),
        *((kind, "RGB") for kind in ("BMP", "PPM", "WEBP", "TGA", "ICO")),
    ],
)
@pytest.mark.parametrize("shade", ["black", "white"])
def test_images_of_every_format_and_mode_keep_black_and_white(
    kind: str, mode: str, shade: str
) -> None:
    image = Image.new("RGB", (64, 64), shade)
    image = _lab(shade) if mode == "LAB" else image.convert(mode)
    assert middle(decoded(saved(image, kind))) == pytest.approx(
        [255 * (shade == "white")] * 3, abs=2
    )


def _lab(shade: str) -> Image.Image:
    return Image.new("LAB", (64, 64), (255 * (shade == "white"), 128, 128))


@for_rows(
    "array, shade",
    {
        "16 bits": (np.full((9, 9), 32896, np.uint16), 128),
        "16 bits, dark": (np.full((9, 9), 257, np.uint16), 1),
        "16 bits, white": (np.full((9, 9), 65535, np.uint16), 255),
        "32 bits, small": (np.full((9, 9), 200, np.int32), 200),
        "32 bits, large": (np.full((9, 9), 65535, np.int32), 255),
        "32 bits, negative": (np.full((9, 9), -5, np.int32), 0),
        "float 0 … 1": (np.full((9, 9), 0.5, np.float32), 128),
        "float 0 … 255": (np.full((9, 9), 200.0, np.float32), 200),
        "not a number": (np.full((9, 9), np.nan, np.float32), 0),
        "infinite": (np.full((9, 9), np.inf, np.float32), 255),
    },
)
def test_an_image_of_deep_greys_is_reduced_to_8_bits(array: np.ndarray, shade: int) -> None:
    assert middle(decoded(saved(Image.fromarray(array), "TIFF"))) == [shade] * 3


def test_a_png_of_16_bits_is_reduced_to_8_bits() -> None:
    image = Image.fromarray(np.full((9, 9), 32896, np.uint16))
    assert middle(decoded(saved(image))) == [128] * 3


@pytest.mark.parametrize("mode", ["RGBA", "LA", "PA"])
def test_transparent_parts_of_a_mat_image_become_white(mode: str) -> None:
    image = Image.new("RGBA", (9, 9), (0, 0, 0, 51))
    if mode == "LA":
        image = image.convert("LA")
    kind = "PNG"
    if mode == "PA":
        image = Image.new("RGBA", (9, 9), (0, 0, 0, 0)).quantize()
        assert middle(decoded(saved(image, kind))) == WHITE
        return
    assert middle(decoded(saved(image, kind))) == [204] * 3


def test_a_transparent_colour_is_white() -> None:
    image = Image.new("RGB", (9, 9), (10, 20, 30))
    assert middle(decoded(saved(image, transparency=(10, 20, 30)))) == WHITE


@pytest.mark.parametrize(
    "orientation, red_at", [(1, "left"), (3, "right"), (6, "top"), (8, "bottom")]
)
def test_a_photograph_is_turned_as_its_exif_orientation_says(orientation: int, red_at: str) -> None:
    image = Image.new("RGB", (80, 80), "white")
    image.paste("red", (0, 0, 20, 80))
    exif = Image.Exif()
    exif[0x0112] = orientation
    field = decoded(saved(image, "PNG", exif=exif), "stretch")
    row, column = {
        "left": (571, 50),
        "right": (571, -50),
        "top": (50, 1181),
        "bottom": (-50, 1181),
    }[red_at]
    assert field[row, column].tolist() == [255, 0, 0]
    assert field[571, 1181].tolist() == WHITE


def test_the_first_frame_of_a_film_counts() -> None:
    frames = [Image.new("RGB", (9, 9), shade) for shade in ("red", "blue")]
    assert middle(decoded(saved(frames[0], "GIF", save_all=True, append_images=frames[1:]))) == [
        255,
        0,
        0,
    ]


@pytest.mark.quick_cases("0", "1", "2", "3", "4", "5")
@pytest.mark.parametrize("seed", range(25))
def test_damaged_bytes_never_escape_as_something_else(seed: int) -> None:
    dice = np.random.default_rng(seed)
    image = Image.effect_noise((60, 40), 60).convert("RGB")
    kind = ["PNG", "JPEG", "TIFF", "GIF", "WEBP"][seed % 5]
    content = bytearray(saved(image, kind))
    for at in dice.integers(0, len(content), 12):
        content[at] = int(dice.integers(256))
    try:
        assert decoded(bytes(content), "fit").shape == (HEIGHT, WIDTH, 3)
    except BackgroundError as error:
        assert error.file == "mat.png"


@pytest.mark.parametrize(
    "size, alike",
    [((WIDTH, HEIGHT), True), ((300, 200), False)],
    ids=["the field's", "another"],
)
def test_mat_fits_share_a_cached_image_only_if_they_give_the_same_pixels(
    size: tuple[int, int], alike: bool, home: Path, tmp_path: Path
) -> None:
    (tmp_path / "mat.png").write_bytes(saved(Image.new("RGB", size, "gray"), compress_level=1))
    prepared = {
        mat_cache.FieldFiles.prepare(tmp_path / "mat.png", (), fit).pixels
        for fit in BACKGROUND_FITS
    }
    assert len(prepared) == (1 if alike else len(BACKGROUND_FITS))
