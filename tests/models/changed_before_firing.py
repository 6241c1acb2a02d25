# What matched may no longer match when its time has come.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()

    def init():
        goal.set('wait')

    def go(goal='wait', light='colour:green'):
        goal.set('gone')

    def stop_here(goal='wait', light='colour:red'):
        print('red at %.3f' % self.now())
        goal.set('wait')

    def switch(goal='gone', light='colour:?c'):
        print('colour at firing', c)
        goal.clear()


class Light(Model):
    colour = 'none'

    def start(self):
        yield 0.1
        self.colour = 'green'
        yield 0.02
        self.colour = 'red'
        yield 0.06
        self.colour = 'blue'
        yield 0.1
        self.colour = 'green'
        yield 0.07
        self.colour = 'red'
        yield 0.02
        self.colour = 'blue'


class World(Model):
    light = Light()


world = World()
world.agent = Agent()
log_everything(world)
world.run()
print('end at %.3f' % world.now())
