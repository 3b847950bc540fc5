"""Name the colour under the left sensor, and say it."""
# %%sim_magic_preloaded -b Rainbow_bands -x 300 -y 500

colour = colorLeft.color_name
print("This is code", colorLeft.color)
say("I see " + colour)
