"""Draw a house in one stroke."""
# %%sim_magic_preloaded -b Empty_Map -p -x 800 -y 300 -a 0

WHEEL_MM = 56
SPACING_MM = 180
PI = 3.141592653589793


def line(length_mm):
    tank_drive.on_for_rotations(SpeedPercent(40), SpeedPercent(40), length_mm / (PI * WHEEL_MM))


def left(angle):
    # To turn on the spot, each wheel runs along a circle whose diameter is the wheel spacing.
    tank_turn.on_for_rotations(-100, SpeedPercent(20), angle / 360 * SPACING_MM / WHEEL_MM)


roof_mm = 200 * 2**0.5

line(400)
left(90)
line(300)
left(45)
line(roof_mm)
left(90)
line(roof_mm)
left(45)
line(300)
print("This is the house.")
