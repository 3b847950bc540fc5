"""The pictures of the 5×5 matrix: each is five digits of base 32, one for each row from the top.

Source: Pybricks and the BBC micro:bit (MIT).
"""

from __future__ import annotations

from collections.abc import Mapping

_PACKED = (
    "0000088808aa000avavaepejepi49jcicid8800048884844480a4a004e400004800e00000801248g"
    "eaaae4c44ee2e8ee2e2eaae22e8e2ee8eaee2444eaeaeeae2e0808004048248420e0e084248eh604"
    "ehljcciuiisisisegggesiiisugsguugsggegjheiiuiis888sv22icikokigggguhrlhhhpljhciiic"
    "sisggciic6sisihegc2sv4444iiiichhha4hhlrhiiciiha444u48gue888eg8421e222e4a0000000v"
    "840000eiifggsis0egge22eiecisge68s88eie2cggsii808882022cgkoki888860rlhh0siii0ciic"
    "0sisg0eie20eggg0684o88e870iiif0hha40hhlr0icci0ha4o0u48u64c4688888o8c8o00c30"
)
CHARACTERS = tuple(_PACKED[at : at + 5] for at in range(0, len(_PACKED), 5))
"""The pictures of the ASCII characters from the blank to `~`, in order, each as five digits of base 32."""
DIGITS = ["33333", "11111", "31323", "31313", "23311", "32313", "32333", "31111", "33033", "33313"]
"""The pictures of the digits 0 to 9, which use only the right two columns of the matrix; `<< 3` moves such a picture to
the left two.
"""
ICONS: Mapping[str, str] = {
    "UP": "4evee",
    "DOWN": "eeve4",
    "LEFT": "4fvf4",
    "RIGHT": "4uvu4",
    "ARROW_RIGHT_UP": "7358g",
    "ARROW_RIGHT_DOWN": "g8537",
    "ARROW_LEFT_UP": "sok21",
    "ARROW_LEFT_DOWN": "12kos",
    "ARROW_UP": "4el44",
    "ARROW_DOWN": "44le4",
    "ARROW_LEFT": "48v84",
    "ARROW_RIGHT": "42v24",
    "HAPPY": "rr0he",
    "SAD": "rr0eh",
    "EYE_LEFT": "00oo0",
    "EYE_RIGHT": "00330",
    "EYE_LEFT_BLINK": "000o0",
    "EYE_RIGHT_BLINK": "00030",
    "EYE_RIGHT_BROW": "03000",
    "EYE_LEFT_BROW": "0o000",
    "EYE_LEFT_BROW_UP": "o0000",
    "EYE_RIGHT_BROW_UP": "30000",
    "HEART": "avve4",
    "PAUSE": "0aaa0",
    "EMPTY": "00000",
    "FULL": "vvvvv",
    "SQUARE": "0eee0",
    "TRIANGLE_RIGHT": "8cec8",
    "TRIANGLE_LEFT": "26e62",
    "TRIANGLE_UP": "04ev0",
    "TRIANGLE_DOWN": "0ve40",
    "CIRCLE": "evvve",
    "CLOCKWISE": "uiin2",
    "COUNTERCLOCKWISE": "f99t8",
    "TRUE": "12k80",
    "FALSE": "ha4ah",
}
"""The pictures of Pybricks' `Icon`, by name, each as five digits of base 32."""
