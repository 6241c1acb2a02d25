# seeds: 1 2
# Similar values retrieved, explicit Partial requests, its limit, and a threshold that partial matches do not reach.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.1, threshold=-1.5)
    partial = Partial(memory, strength=2.0, limit=-1.0)
    other = Partial(memory, strength=0.5, limit=-2.0)
    noise = DMNoise(memory, noise=0.02)

    def init():
        partial.similarity('red', 'pink', -0.3)
        partial.similarity('red', 'blue', -0.8)
        other.similarity('red', 'blue', -0.1)
        memory.add('colour:pink size:1')
        memory.add('colour:blue size:2')
        memory.add('colour:grey size:3')
        goal.set('ask red')

    def ask(goal='ask ?c'):
        memory.request('colour:?c')
        goal.set('first ?c')

    def first(goal='first ?c', retrieval='colour:?x'):
        print(c, x, '%.4f' % self.now())
        other.request('colour:?c')
        retrieval.clear()
        goal.set('second ?c')

    def second(goal='second ?c', retrieval='colour:?x'):
        print(c, x, '%.4f' % self.now())
        memory.request('colour:?c size:9')
        goal.set('third ?c')

    def third(goal='third ?c', memory='error:True'):
        print('too different', '%.4f' % self.now())
        memory.request('colour:!?c size:?s')
        goal.set('fourth')

    def fourth(goal='fourth', retrieval='colour:?x size:?s', memory='busy:False error:False'):
        print(x, s, '%.4f' % self.now())
        goal.clear()


agent = Agent()
log_everything(agent)
agent.run()
