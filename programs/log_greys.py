"""Log the light every tenth of a second until the mat is black."""
# %%sim_magic_preloaded -b Grey_bands

import time

# Each line `NAME: number` becomes a row of the log and a point of the chart.
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
sensor_val = colorLeft.reflected_light_intensity_pc
print("Colour: " + str(sensor_val))

# Black reads 0, on a brick about 5, with noise a little more.
while sensor_val > 6:
    time.sleep(0.1)
    sensor_val = colorLeft.reflected_light_intensity_pc
    print("Colour: " + str(sensor_val))

# One last row where the robot has come to rest.
tank_drive.off()
print("Colour: " + str(colorLeft.reflected_light_intensity_pc))
