"""Read everything that a colour sensor can tell, once, where the robot stands."""
# %%sim_magic_preloaded -b Grey_bands -x 325

# Move the robot (drag it, or start with another -x) and run again.
print("reflected_light_intensity:", colorLeft.reflected_light_intensity)
print("reflected_light_intensity_pc:", colorLeft.reflected_light_intensity_pc)
print("full_reflected_light_intensity:", colorLeft.full_reflected_light_intensity)
print("rgb:", colorLeft.rgb)
print("color:", colorLeft.color)
print("color_name:", colorLeft.color_name)
