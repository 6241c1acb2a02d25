# seeds: 1 2
# Blends of numbers, with base levels and noise; chunks with other slots or other words are left out.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = BlendingMemory(retrieval, latency=0.4, threshold=-4)
    fixed = DMFixed(memory)
    noise = DMNoise(memory, noise=0.1)

    def init():
        memory.add('option:left payoff:1', fixed=0.5)
        memory.add('option:left payoff:2', fixed=1.5)
        memory.add('option:left payoff:4', fixed=0.25)
        memory.add('option:left payoff:1000 other:1', fixed=-2)
        memory.add('option:right payoff:3')
        memory.add('option:right payoff:many')
        goal.set('left')

    def ask(goal='left'):
        memory.request('option:left payoff:?')
        goal.set('left answer')

    def answer(goal='left answer', retrieval='option:left payoff:?p'):
        print('%.4f %.4f' % (float(p), self.now()), '%.5f' % retrieval['payoff'])
        memory.request('option:right')
        retrieval.clear()
        goal.set('right answer')

    def right(goal='right answer', retrieval='option:right payoff:?p'):
        print(p, '%.4f' % self.now())
        memory.request('option:middle')
        goal.set('fail')

    def fail(goal='fail', memory='error:True'):
        print('%.3f' % self.now())
        goal.clear()


for i in range(3):
    Agent().run()
