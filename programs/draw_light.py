"""Draw the light that the left sensor sees as a bar on the brick's display."""
# %%sim_magic_preloaded -b Grey_bands

from ev3dev2.display import Display
from ev3dev2.sound import Sound

display = Display()
sound = Sound()
tank_drive.on(SpeedPercent(30), SpeedPercent(30))

light = 100
while light > 6:
    light = colorLeft.reflected_light_intensity_pc
    # Nothing is seen before update().
    display.text_grid("Light: " + str(round(light)) + " %", x=6, y=2)
    display.rectangle(False, 20, 50, 20 + round(1.38 * light), 70)
    display.rectangle(False, 20, 50, 158, 70, fill_color=None)
    display.update()

tank_drive.off()
sound.play_song([("C5", "q"), ("G4", "q"), ("C4", "h")])
