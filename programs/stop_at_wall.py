"""Drive towards the wall and stop in front of it."""
# %%sim_magic_preloaded -b Empty_Map -o Wall -x 400 -y 600

STOP_CM = 15

tank_drive.on(SpeedPercent(30), SpeedPercent(30))
while ultrasonic.distance_centimeters > STOP_CM:
    pass
tank_drive.off()
print("Distance: " + str(ultrasonic.distance_centimeters))
