# How texts, dicts, chunks and objects become chunks, and how they print.
from python_actr import *


class Thing(Model):
    name = 'thing'
    colour = 'red'
    size = 3
    weight = 1.5
    hidden = None


class Agent(ACTR):
    goal = Buffer()
    other = Buffer()
    memory = Memory(other)

    def init():
        for text in ['a:1 b:2', 'hello world', 'one two three:3', 'x:a:b', 'z:1 y:2 x:3', 'b:1 a:2']:
            goal.set(text)
            print('chunk', goal.chunk, len(goal), sorted(goal.chunk.keys(), key=str))
        goal.set({'n': 3, 'f': 0.5, 't': 'text'})
        print(goal.chunk, type(goal['n']).__name__, type(goal['f']).__name__)
        other.set(goal.chunk)
        print(other.chunk, other.chunk == goal.chunk, goal == other.chunk)
        goal.modify(n=4)
        print(goal.chunk, other.chunk)
        goal.set('first second')
        goal.modify(_0='zeroth', _1=1)
        print(goal.chunk, goal[0], goal[1])
        print(goal.isEmpty(), len(goal))
        goal.clear()
        print(goal.isEmpty(), len(goal), goal.chunk)
        goal.set('go:1')

    def see(goal='go:1'):
        goal.set(top.thing)
        print(goal.chunk)
        other.set({'go': 2, 'slot': 'value'})
        goal.set('go:2')

    def copy_them(goal='go:?g', other='slot:?v go:?g'):
        goal.set('now ?v')
        memory.add('fact ?v ?g')
        memory.add('fact ?v ?g')
        memory.add(other)
        memory.add({'1': 'one', 'k': 2})
        for chunk in memory.dm:
            print('dm', chunk)


class World(Model):
    thing = Thing()


world = World()
world.agent = Agent()
log_everything(world)
world.run()
print(Chunk('a b c:d'), Chunk({'k': 1}), Chunk(Chunk('p q')))
