from pybricks.parameters import Button


class Menu:
    def __init__(self, ev3, entries):
        self.ev3 = ev3
        self.entries = entries
        self.i = 0
        self.shown = None

    def step(self):
        if self.shown != self.i:
            self.ev3.screen.clear()
            self.ev3.screen.print(self.entries[self.i][0])
            self.shown = self.i
        b = self.ev3.buttons.pressed()
        if Button.DOWN in b:
            self.i = (self.i + 1) % len(self.entries)
        elif Button.CENTER in b:
            self.entries[self.i][1]()
