# Several methods without parameters, helper methods, start(), and what a body sees of its agent and the agent's ancestors.
from python_actr import *


class Module(Model):
    value = 0

    def start(self):
        self.value = 1

    def bump(self, by=2):
        self.value += by
        return self.value


class Agent(ACTR):
    goal = Buffer()
    module = Module()
    items = ['a', 'b']
    table = {'k': 1}

    def setup_b():
        print('b')
        goal.set('step:1')

    def setup_a():
        print('a', module.value, self.items, top.title)

    def zeta():
        print('zeta', sorted(table), goal.chunk)

    def helper(self, x):
        return x * 2

    def one(goal='step:1'):
        print('body sees', items, table, title, module.bump(), module.bump(by=5), self.helper(4), self.parent.title)
        self.items.append('c')
        goal.set('step:2')

    def two(goal='step:2', module='value:?v'):
        print('value', v, self.items, Agent2.items if False else '')
        top.title = 'changed'
        goal.set('step:3')

    def three(goal='step:3', top='title:changed'):
        print('title', top.title, title)
        goal.clear()


class World(Model):
    title = 'world'
    title2 = 'second'


world = World()
world.first = Agent()
world.second = Agent()
world.run()
print(world.first.items, world.second.items, Agent.items)
