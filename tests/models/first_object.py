# seeds: 1 2 3
# The first object that a world is given by being set on it: visions overlook it, and a chunk of it has no name of its own.
import ccm
from ccm.lib.actr import *

log = ccm.log()


class World(ccm.Model):
    pass


class Ball(ccm.Model):
    isa = 'ball'
    salience = 0.8


class Named(ccm.Model):
    name = 'own name'


class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    copy = Buffer()
    vision = SOSVision(visual, delay=0.05)

    def init():
        goal.set('look 0')

    def look(goal='look ?n!8', vision='busy:False'):
        vision.request('isa:?')
        goal.set('see ?n')

    def see(goal='see ?n', visual='isa:?what', vision='busy:False'):
        print(n, what, visual.chunk)
        copy.set(first)
        print(copy.chunk, first.parent is top)
        visual.clear()
        n = int(n) + 1
        goal.set('look ?n')

    def blind(goal='see ?n', vision='error:True'):
        print(n, 'nothing')
        n = int(n) + 1
        goal.set('look ?n')


def show(world):
    print([str(Chunk(child)) for child in world.get_children() if not isinstance(child, ACTR)])


objects = ccm.Model(isa='red', salience=0.5, x=0.25), ccm.Model(isa='blue', salience=0.25), Ball(colour='green')
for number in range(3):
    world = World()
    world.first = objects[number].__class__(**dict(objects[number].__dict__))
    world.second = ccm.Model(isa='cube', salience=0.3)
    world.third = Ball()
    world.agent = Agent()
    show(world)
    ccm.log_everything(world)
    world.run(limit=3)
    show(world)

agent_first = World()
agent_first.agent = Agent()
agent_first.first = ccm.Model(isa='red')
show(agent_first)
agent_first.run(limit=1)

named = ccm.Model()
named.n = Named()
named.m = Named()
show(named)
print(Chunk(named.n), Chunk(named.m), len(named.get_children()))
named.n = named.m
print(len(named.get_children()))
given = ccm.Model()
given.r = ccm.Model(isa='r', name='mine')
given.s = ccm.Model(isa='s', name='mine')
print(Chunk(given.r), '|', Chunk(given.s))
replaced = ccm.Model()
replaced.q = ccm.Model(x=1)
replaced.q = ccm.Model(x=2)
show(replaced)
by_keyword = World(red=ccm.Model(isa='red'))
by_keyword.x = ccm.Model(isa='x')
show(by_keyword)
running = World()
running.run(limit=0)
running.red = ccm.Model(isa='red')
show(running)
