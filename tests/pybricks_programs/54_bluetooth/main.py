#!/usr/bin/env pybricks-micropython

# Before running this program, make sure the client and server EV3 bricks are
# paired using Bluetooth
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.tools import wait
from pybricks.messaging import BluetoothMailboxClient, BluetoothMailboxServer, TextMailbox, NumericMailbox, LogicMailbox

SERVER = 'ev3dev'

ev3 = EV3Brick()
m = Motor(Port.A)
IS_SERVER = False

client = BluetoothMailboxClient()
mbox = TextMailbox('greeting', client)
num = NumericMailbox('speed', client)
flag = LogicMailbox('go', client)
print("mailbox before:", mbox.read())
m.run_angle(300, 180)
print('establishing connection...', m.angle())
client.connect(SERVER)
print('connected!')

mbox.send('hello!')
mbox.wait()
print(mbox.read())
while True:
    num.wait_new()
    m.run(num.read())
    flag.send(True)
