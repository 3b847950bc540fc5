"""Follow the line round the lollipop and along its stick to the red bar."""
# %%sim_magic_preloaded -b Lollipop

SPEED = 15
GAIN = 1.2

# The line runs between the two sensors: the one that sees less light is over it, and
# the robot steers to that side, up to turning on the spot. The stick ends at a red bar.
red = False
while not red:
    left = colorLeft.reflected_light_intensity_pc
    right = colorRight.reflected_light_intensity_pc
    steering = GAIN * (left - right)
    tank_turn.on(max(-100, min(100, steering)), SPEED)
    red = left > 84 and colorLeft.color_name == "Red"

tank_turn.off()
print("There is the red bar.")
