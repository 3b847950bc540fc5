from ev3dev2.sensor import Sensor, INPUT_4
ir = Sensor(INPUT_4)
ir.mode = 'IR-PROX'
print(ir.driver_name, ir.value())
