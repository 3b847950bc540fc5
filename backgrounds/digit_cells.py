"""What stands in each cell of the digit sheets: eleven rows of twenty digits."""

from __future__ import annotations

from typing import NamedTuple


class Sheet(NamedTuple):
    """One sheet; every field has a line of text for each row."""

    labels: tuple[str, ...]
    """A digit for each cell."""
    boxes: tuple[str, ...]
    """For each cell the box around the bright pixels of its digit, as four hexadecimal figures: x0, y0, x1, y1."""
    means: tuple[str, ...]
    """For each cell the mean of its pixels, 0 … 255."""


# fmt: off
WHITE_SHEET = Sheet(
    labels=(
        "38256176994503773651",
        "23971392153568599053",
        "97570180866207267927",
        "66410394197084044756",
        "66710778407772238642",
        "11767131976924970876",
        "40036138834205273688",
        "86621024753984868121",
        "64615346012668777497",
        "34051106803917457484",
        "91465606216534154117",
    ),
    boxes=(
        "43ad 22cc 21bc 32cc 31bb 429c 42ad 41bc 43ad 33ad 22dd 22cd 24db 33bd 33be 33be 22cc 52bb 22cc 42bd",
        "23cc 22bc 33ad 33dd 42bc 22bc 53ad 21bc 429c 23cb 22bd 32ac 41cb 22cd 22bc 53bd 43ad 32bc 42bc 33bd",
        "43ce 33ad 42bd 43ad 32cc 629d 33bd 23cc 32bd 31bb 41bc 31bc 13cc 43bd 13ca 51ab 24be 43bd 31cc 34be",
        "41bb 21cc 32dd 52ac 22dd 12bc 33be 33bd 42ac 43ad 43bd 22cc 22bc 42cd 42bd 43bd 32bc 43ad 32bd 51bb",
        "42bc 31bb 24ce 52ac 23db 33ce 14be 42bd 43ad 32cc 33ae 33be 43ad 42bc 22cc 32bc 42bd 41bb 32cc 31bc",
        "629c 628c 04be 31dc 439e 629d 32bc 52ac 53ad 33ce 51ac 43be 32cc 43ac 33ae 33be 42bc 32bd 33be 22da",
        "13bc 22cc 32cd 32ad 31cb 52ac 32ad 32cd 22cc 13cb 32bc 22bc 32cd 34cb 33db 33be 22bc 31bb 32cc 32bc",
        "42bd 41bc 41bc 21bc 42bc 22dc 31cc 22dc 53bd 32dd 33bd 33ae 22bd 33cd 42bd 51ab 42bc 32bc 32db 52ac",
        "41bb 33dd 42bc 42bc 32bc 23cc 33ad 41bc 32bc 52ad 21bc 41bc 31cb 42bd 34cd 22dc 43ad 33cd 43ad 33be",
        "22bc 42dd 22cc 33dc 628c 52ad 32cc 51ab 32cd 13cc 22cc 43ae 629c 33bd 32bc 21db 33ae 42ac 32bd 33ec",
        "43bd 62ac 23cc 51ac 32dd 41bb 32bc 41bc 22cb 42bd 41bc 33eb 52ad 22cd 31dc 42bd 24cb 629c 32bd 34ce",
    ),
    means=(
        "39 37 38 39 50 11 26 37 25 45 58 44 23 30 29 37 54 28 61 25",
        "30 52 25 53 22 42 27 42 11 23 39 29 38 38 55 41 30 33 33 22",
        "33 42 53 25 30 20 38 57 42 50 32 31 31 38 32 21 30 33 34 26",
        "39 75 29 18 50 57 35 33 21 32 29 49 45 25 43 24 38 25 27 22",
        "28 45 38 27 38 36 30 38 33 50 28 37 15 33 46 38 39 32 35 32",
        "19 12 26 49 20 20 31 15 21 47 23 27 46 22 28 25 19 35 28 41",
        "44 70 55 34 46 21 34 40 37 28 25 37 26 26 43 28 40 50 40 39",
        "27 31 38 44 27 39 51 51 26 36 22 25 44 35 37 21 37 17 33 22",
        "33 27 30 24 46 39 26 49 39 20 40 40 52 51 35 36 27 34 29 39",
        "58 47 40 30 16 27 38 28 46 31 41 28 24 42 35 38 28 24 47 21",
        "35 21 46 23 45 23 58 30 45 25 37 33 32 39 30 51 27 16 29 36",
    ),
)
BLACK_SHEET = Sheet(
    labels=(
        "50001332352803941291",
        "79011592577333439597",
        "19910352191523610103",
        "81748591006022464168",
        "13680549264037773576",
        "03706097183241980301",
        "70850780652131385257",
        "29476900939740684297",
        "60357027233661483021",
        "76973662591913470116",
        "98238740185650833768",
    ),
    boxes=(
        "42cd 22dc 23dc 42bd 629d 32bc 32bd 52ac 22cd 32bd 22cc 32bc 42ac 23cb 539d 32ac 52ac 22cc 43bd 629c",
        "439e 33bd 23cc 42bd 529c 23cc 43ce 12cb 32dc 33ce 33ce 22cd 32bc 22cd 43ad 42ad 53ad 32bc 32bd 33be",
        "529d 33ce 33bd 42ad 32cc 42bd 42ad 52ac 529c 439e 629c 34cb 22cc 22bd 31cb 52ac 32ec 629c 42ac 22cd",
        "23dc 42ac 33ce 43bd 42bd 31bc 43bd 42bd 22cc 22bc 41cb 22dc 24cb 22cc 529c 41bc 32cd 529d 41ac 42bd",
        "42bd 52ad 32bc 32cd 32cc 32cd 22cc 43bd 21bc 31bb 43cd 32bc 32bc 23ce 43bd 53ad 32bd 32cc 43ad 51ab",
        "22cc 22ac 43bd 32cc 41bc 22dc 43bd 43ad 52ad 42cd 12bc 51ac 42bc 529c 43ad 42bd 22cc 22ad 32cc 42bd",
        "23be 32bd 22cd 34cc 32bc 33be 43bd 23dc 41ab 32cd 12cc 52ac 12bc 52ac 12bc 42bd 32cd 32cc 32cc 43be",
        "31cc 33ad 22cd 44ce 41bb 43bd 32cc 32cc 23cd 22cc 42ad 33ce 32dd 22cd 31bc 42bd 21cb 31dc 23cd 24be",
        "41bc 22cc 12bc 22cc 23bd 42bc 22cb 33ce 32cc 22bc 22cd 51bb 41bc 42bd 32ad 42bd 42ad 22dc 43ea 62ad",
        "33ce 31bb 23be 33be 22cc 41ac 41ab 22cc 33dc 539d 42ac 33bd 528c 12cc 33bd 33be 33bb 52ad 529c 41bb",
        "33cd 42ac 22cb 32bd 42bd 33ae 42ac 33bd 629c 43bd 33db 31bb 23cb 23cb 42ad 22bc 12bc 23be 31bb 42ad",
    ),
    means=(
        "33 45 51 55 20 44 41 29 46 26 60 39 27 35 19 35 31 59 31 15",
        "20 56 50 23 35 40 25 46 29 47 42 46 39 42 19 25 27 40 50 32",
        "35 34 37 18 48 41 27 29 20 22 17 26 60 47 49 18 48 20 27 58",
        "37 22 32 24 27 37 41 29 34 47 42 56 25 47 16 36 33 15 32 40",
        "22 32 43 45 44 30 33 35 46 38 30 48 31 29 36 34 33 39 28 22",
        "51 35 26 34 29 56 36 27 20 59 43 22 28 23 28 45 55 40 45 28",
        "41 36 55 15 31 30 33 53 27 45 50 27 43 14 36 30 43 45 43 38",
        "47 32 49 22 30 35 57 57 38 33 35 33 50 60 39 39 34 40 37 24",
        "24 42 44 44 38 49 37 33 36 36 45 42 40 28 25 37 25 31 29 18",
        "37 35 40 39 46 21 24 41 32 19 27 37 16 39 34 39 34 24 25 35",
        "41 27 35 42 27 25 23 40 17 34 23 45 30 46 28 42 46 45 34 30",
    ),
)
# fmt: on
