#!/usr/bin/env python3
"""Experiment 2: speed against power. Writes a csv for LibreOffice."""
import csv
import statistics
from datetime import datetime
from pathlib import Path
from time import sleep, time

from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C
from ev3dev2.power import PowerSupply

OUT = Path(__file__).resolve().parent / 'data'
OUT.mkdir(exist_ok=True)
stamp = datetime.now().strftime('%Y-%m-%d_%H-%M-%S')
path = OUT / 'speed_{}.csv'.format(stamp)

left, right = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)
for m in (left, right):
    m.reset()

fields = ['time', 'power', 'position', 'speed', 'volts']
rows = []
t0 = time()
for power in (10, 20, 30, -30, -20, -10):
    left.on(power)
    right.on(power)
    sleep(0.4)  # let it settle
    for _ in range(10):
        rows.append({
            'time': round(time() - t0, 3),
            'power': power,
            'position': left.position,
            'speed': left.speed,
            'volts': '%.2f' % PowerSupply().measured_volts,
        })
        sleep(0.05)
left.off()
right.off()

with path.open('w', newline='') as f:
    writer = csv.DictWriter(f, fieldnames=fields)
    writer.writeheader()
    writer.writerows(rows)

with path.open() as f:
    back = list(csv.DictReader(f))
print(len(back), 'rows of', len(back[0]), 'columns')
for power in (10, 20, 30, -30, -20, -10):
    speeds = [int(r['speed']) for r in back if int(r['power']) == power]
    mean = statistics.mean(speeds)
    off = abs(mean - power * 10.5) < 15
    print('{:>4} % mean {} sd {}'.format(power, 'as set' if off else round(mean), 'small' if statistics.pstdev(speeds) < 15 else 'large'))
print(path.suffix, path.exists(), path.parent.name)
