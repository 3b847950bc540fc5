import json
import os

from .robot import Robot

HERE = os.path.dirname(os.path.abspath(__file__))


def load_config(name='config.json'):
    with open(os.path.join(HERE, name)) as f:
        return json.load(f)


__all__ = ['Robot', 'load_config']
