# Failures that ask again, requests from other modules' callbacks, values that are numbers, and ties in memory.
# seeds: 1 2 3
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.2, threshold=0.5, maximum_time=1.5)
    noise = DMNoise(memory, noise=0.6)

    def init():
        for i in range(6):
            memory.add('fact key:%d value:%d' % (i % 2, i))
        goal.set('key:0 tries:0')

    def ask(goal='key:?k tries:?t!9', memory='busy:False'):
        memory.request('fact key:?k')
        t = int(t) + 1
        goal.set('asked:?k tries:?t')

    def got(goal='asked:?k tries:?t', retrieval='fact value:?v', memory='busy:False error:False'):
        print('%.2f' % self.now(), t, 'value', v)
        k = (int(v) + 1) % 2
        goal.set('key:?k tries:?t')
        retrieval.clear()

    def again(goal='asked:?k tries:?t', memory='error:True'):
        print('%.2f' % self.now(), t, 'forgot')
        goal.set('key:?k tries:?t')


agent = Agent()
agent.run(limit=10)
