"""Follow the line round the lollipop and along its stick to the red bar."""
# %%sim_magic_preloaded -b Lollipop

SPEED = 25
GAIN = 0.6

# The line runs between the two sensors: the one that sees less light is over it, and
# the robot steers to that side. At the red bar the left sensor says so.
red = False
while not red:
    left = colorLeft.reflected_light_intensity_pc
    right = colorRight.reflected_light_intensity_pc
    tank_turn.on(GAIN * (left - right), SPEED)
    red = colorLeft.color_name == 'Red'

tank_turn.off()
print('There is the red bar.')
