from base import ahead


def main():
    ahead(30, speed=60)
