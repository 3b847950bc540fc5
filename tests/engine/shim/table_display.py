"""Checks of the display: what each call draws, told by the dark pixels; fonts; the frame buffer below."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

_INK = """
import io, os, tempfile
from PIL import BdfFontFile, Image
from ev3dev2 import fonts
from ev3dev2.display import *
from ev3dev2.display import FbMem
d = Display()

def ink(part=None):
    '''Box of what is dark, and how many pixels are.'''
    image = (part or d.image).point([255 * (level < 128) for level in range(256)])
    return image.getbbox(), image.histogram()[255]

def seen():
    '''The same of the memory that the display shows.'''
    return ink(Image.frombytes('L', d.shape, d.mmap[1::4]))

def drawn(call):
    d.clear()
    call(d)
    return ink()

def picture(color, size=(6, 4)):
    file = io.BytesIO()
    Image.new('L', size, color).save(file, 'PNG')
    file.seek(0)
    return file
"""

DISPLAY = Table(
    "ev3dev2.display",
    _INK,
    (
        Check(
            "str(d), str(Display('face')), Display('face').desc",
            "('Display', 'face', 'face')",
            "Display Display.__init__ Display.__str__ Display.desc",
        ),
        Check(
            "d.xres, d.yres, d.shape",
            "(178, 128, (178, 128))",
            "Display.xres Display.yres Display.shape",
        ),
        Check("d.image.mode, d.image.size, ink()", "('L', (178, 128), (None, 0))", "Display.image"),
        Check(
            "d.GRID_COLUMNS, d.GRID_COLUMN_PIXELS, d.GRID_ROWS, d.GRID_ROW_PIXELS",
            "(22, 8, 12, 10)",
            "Display.GRID_COLUMNS Display.GRID_COLUMN_PIXELS Display.GRID_ROWS Display.GRID_ROW_PIXELS",
        ),
        Check(
            "drawn(lambda d: d.draw.rectangle((10, 10, 60, 20), fill='black'))",
            "((10, 10, 61, 21), 561)",
            "Display.draw",
        ),
        Check("d.clear(), ink()", "(None, (None, 0))", "Display.clear"),
        Check("drawn(lambda d: d.line())", "((10, 10, 51, 51), 41)", "Display.line"),
        Check("drawn(lambda d: d.line(x1=0, y1=5, x2=99, y2=5, width=3))", "((0, 4, 100, 7), 300)"),
        Check("drawn(lambda d: d.line(x1=0, y1=5, x2=99, y2=5, line_color='grey'))", "(None, 0)"),
        Check(
            "drawn(lambda d: (d.line(), d.line(False, 100, 0, 100, 9)))", "((10, 0, 101, 51), 51)"
        ),
        Check("drawn(lambda d: (d.point(x=170, y=120), d.line()))", "((10, 10, 51, 51), 41)"),
        Check("drawn(lambda d: d.rectangle())", "((10, 10, 81, 41), 2201)", "Display.rectangle"),
        Check(
            "drawn(lambda d: d.rectangle(x1=0, y1=0, x2=9, y2=9, fill_color='white'))",
            "((0, 0, 10, 10), 36)",
        ),
        Check("box, count = drawn(lambda d: d.circle())"),
        Check(
            "box, abs(count - 3.14159 * 40.5 ** 2) < 60",
            "((10, 10, 91, 91), True)",
            "Display.circle",
        ),
        Check(
            "drawn(lambda d: d.circle(x=3, y=3, radius=2, fill_color='white'))[0]", "(1, 1, 6, 6)"
        ),
        Check("drawn(lambda d: d.point())", "((10, 10, 11, 11), 1)", "Display.point"),
        Check("drawn(lambda d: (d.point(x=1), d.point(False, x=3)))", "((1, 10, 4, 11), 2)"),
        Check(
            "drawn(lambda d: d.text_pixels('Hi', x=100, y=50))[0]",
            "(100, 52, 112, 59)",
            "Display.text_pixels",
        ),
        Check("drawn(lambda d: d.text_pixels('Hi', text_color='white'))", "(None, 0)"),
        Check("d.clear(); d.text_pixels('Hi', x=16, y=30)"),
        Check("ink() == drawn(lambda d: d.text_grid('Hi', x=2, y=3))", "True", "Display.text_grid"),
        Check(
            "drawn(lambda d: (d.point(), d.text_grid('Hi', clear_screen=False)))[0]",
            "(0, 2, 12, 11)",
        ),
        Check("set(d.image.tobytes())", "{0, 255}"),
        Check(
            "d.text_grid('x', x=22)",
            "AssertionError: grid columns must be between 0 and 21, 22 was requested",
        ),
        Check(
            "d.text_grid('x', y=-1)",
            "AssertionError: grid rows must be between 0 and 11, -1 was requested",
        ),
        Check("d.text_pixels('x', font='luBS15')", "AssertionError: luBS15 is an invalid font"),
        Check(
            "drawn(lambda d: d.image_filename(picture('black'), x1=20, y1=10))",
            "((20, 10, 26, 14), 24)",
            "Display.image_filename",
        ),
        Check(
            "drawn(lambda d: d.image_filename(picture('black'), True, 1, 2, 7, 6))",
            "((1, 2, 7, 6), 24)",
        ),
        Check("d.image_filename('nothing.png')", "FileNotFoundError"),
        Check("d.rectangle(); seen()", "None"),
        Check("seen()", "(None, 0)"),
        Check("d.update(), seen()", "(None, ((10, 10, 81, 41), 2201))", "Display.update"),
        Check("d.image.paste(0, (0, 0, 178, 128)), seen()", "(None, ((10, 10, 81, 41), 2201))"),
        Check("d.update(), seen()", "(None, ((0, 0, 178, 128), 22784))"),
        Check(
            "d.reset_screen(), ink(), seen()",
            "(None, (None, 0), (None, 0))",
            "Display.reset_screen",
        ),
    ),
)

_BDF = """
bdf = '''STARTFONT 2.1
FONT -x-block-medium-r-normal--4-40-75-75-C-40-ISO8859-1
SIZE 4 75 75
FONTBOUNDINGBOX 4 4 0 0
STARTPROPERTIES 2
FONT_ASCENT 4
FONT_DESCENT 0
ENDPROPERTIES
CHARS 1
STARTCHAR A
ENCODING 65
SWIDTH 500 0
DWIDTH 4 0
BBX 4 4 0 0
BITMAP
F0
F0
F0
F0
ENDCHAR
ENDFONT
'''
folder = tempfile.mkdtemp()
BdfFontFile.BdfFontFile(io.BytesIO(bdf.encode())).save(os.path.join(folder, 'block4'))
"""

FONTS = Table(
    "ev3dev2.fonts",
    _INK + _BDF,
    (
        Check(
            "len(fonts.available()), fonts.available()[::199]",
            "(200, ['charB08', 'timR24'])",
            "available",
        ),
        Check(
            "fonts.load('luBS15')",
            'Exception: Failed to load font "luBS15". Check ev3dev.fonts.available()',
        ),
        Check("fonts.__file__ = os.path.join(folder, '__init__.py')"),
        Check("len(fonts.available()), fonts.available()[0]", "(201, 'block4')"),
        Check("font = fonts.load('block4')"),
        Check(
            "drawn(lambda d: d.text_pixels('AA', x=50, y=20, font=font))",
            "((50, 20, 58, 24), 32)",
            "load",
        ),
        Check(
            "drawn(lambda d: d.text_grid('A', x=1, y=1, font='block4'))", "((8, 10, 12, 14), 16)"
        ),
        Check("import shutil; shutil.rmtree(folder)"),
    ),
)

FRAME_BUFFER = Table(
    "ev3dev2.display",
    _INK + "fix, var = d.fix_info, d.var_info",
    (
        Check(
            "FbMem.FBIOGET_VSCREENINFO, FbMem.FBIOGET_FSCREENINFO, FbMem.FB_VISUAL_MONO01, FbMem.FB_VISUAL_MONO10",
            f"({0x4600}, {0x4602}, 0, 1)",
            "FbMem.FBIOGET_VSCREENINFO FbMem.FBIOGET_FSCREENINFO FbMem.FB_VISUAL_MONO01 FbMem.FB_VISUAL_MONO10",
        ),
        Check("f = FbMem()"),
        Check(
            "f.fid > 2, len(f.mmap), type(f.fix_info).__name__, type(f.var_info).__name__, d.platform",
            "(True, 91136, 'FixScreenInfo', 'VarScreenInfo', 'ev3')",
            "FbMem FbMem.__init__ FbMem.fid FbMem.mmap FbMem.fix_info FbMem.var_info FbMem.FixScreenInfo "
            "FbMem.VarScreenInfo Display.platform",
        ),
        Check(
            "fix.id_name, fix.smem_len, fix.line_length",
            "(b'st7586', 91136, 712)",
            "FbMem.FixScreenInfo.id_name FbMem.FixScreenInfo.smem_len FbMem.FixScreenInfo.line_length",
        ),
        Check(
            "fix.smem_start, fix.type, fix.type_aux, fix.visual, fix.mmio_start, fix.mmio_len, fix.accel",
            "(0, 0, 0, 2, 0, 0, 0)",
            "FbMem.FixScreenInfo.smem_start FbMem.FixScreenInfo.type FbMem.FixScreenInfo.type_aux "
            "FbMem.FixScreenInfo.visual FbMem.FixScreenInfo.mmio_start FbMem.FixScreenInfo.mmio_len "
            "FbMem.FixScreenInfo.accel",
        ),
        Check(
            "fix.xpanstep, fix.ypanstep, fix.ywrapstep, list(fix.reserved)",
            "(0, 0, 0, [0, 0, 0])",
            "FbMem.FixScreenInfo.xpanstep FbMem.FixScreenInfo.ypanstep FbMem.FixScreenInfo.ywrapstep "
            "FbMem.FixScreenInfo.reserved",
        ),
        Check(
            "var.xres, var.yres, var.xres_virtual, var.yres_virtual, var.xoffset, var.yoffset",
            "(178, 128, 178, 128, 0, 0)",
            "FbMem.VarScreenInfo.xres FbMem.VarScreenInfo.yres FbMem.VarScreenInfo.xres_virtual "
            "FbMem.VarScreenInfo.yres_virtual FbMem.VarScreenInfo.xoffset FbMem.VarScreenInfo.yoffset",
        ),
        Check(
            "var.bits_per_pixel, var.grayscale",
            "(32, 0)",
            "FbMem.VarScreenInfo.bits_per_pixel FbMem.VarScreenInfo.grayscale",
        ),
        Check(
            "[(c.offset, c.length, c.msb_right) for c in (var.red, var.green, var.blue, var.transp)]",
            "[(16, 8, 0), (8, 8, 0), (0, 8, 0), (0, 0, 0)]",
            "FbMem.VarScreenInfo.red FbMem.VarScreenInfo.green FbMem.VarScreenInfo.blue FbMem.VarScreenInfo.transp "
            "FbMem.VarScreenInfo.FbBitField FbMem.VarScreenInfo.FbBitField.offset "
            "FbMem.VarScreenInfo.FbBitField.length FbMem.VarScreenInfo.FbBitField.msb_right",
        ),
        Check(
            "str(var.red)",
            repr("FbBitField (offset 16, length 8, msg_right 0)"),
            "FbMem.VarScreenInfo.FbBitField.__str__",
        ),
        Check(
            "str(var).startswith('178x128 at (0,0), bpp 32, grayscale 0, red FbBitField (offset 16, length 8')",
            "True",
            "FbMem.VarScreenInfo.__str__",
        ),
        Check("f.mmap[:4] = bytes(3)", "IndexError"),
        Check("f.mmap[:8] = bytes(8)"),
        Check("seen()", "((0, 0, 2, 1), 2)", "FbMem.mmap"),
    ),
)
