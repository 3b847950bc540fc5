"""Drive, and read the light as fast as the sensor allows, until the mat is black."""
# %%sim_magic_preloaded -b Grey_bands

# A reading takes 10 ms on the brick: nothing else in this loop takes any time.
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
sensor_val = colorLeft.reflected_light_intensity_pc
print("Colour: " + str(sensor_val))

while sensor_val > 0:
    sensor_val = colorLeft.reflected_light_intensity_pc
    print("Colour: " + str(sensor_val))

tank_drive.off()
