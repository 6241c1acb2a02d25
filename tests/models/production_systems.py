# seeds: 1 2 3
# A bare ProductionSystem chooses at random, knows no utilities, and does not look again before it fires.
from python_actr import *


class Coin(ProductionSystem):
    production_time = 0.2
    production_match_delay = 0.05
    side = 'none'
    tosses = 0

    def init():
        print('begin')

    def heads(self='tosses:!10 open:True'):
        self.side = 'heads'
        self.tosses += 1

    def tails(self='tosses:!10'):
        self.side = 'tails'
        self.tosses += 1

    def edge(self='tosses:!10 side:tails', utility=100):
        self.side = 'edge'
        self.tosses += 1

    open = True


class World(Model):
    coin = Coin()

    def start(self):
        yield 0.83
        self.coin.open = False
        yield 0.5
        self.coin.open = True


world = World()
log_everything(world)
world.run(limit=4)
print(world.coin.side, world.coin.tosses)
