# Modules of one's own: of memory, of utility, subclasses of buffer, memory and agent, and constructors with arguments.
from python_actr import *
from python_actr.actr import *


class Recency(MemorySubModule):
    def __init__(self, memory, scale=1.0):
        MemorySubModule.__init__(self, memory)
        self.scale = scale

    def create(self, chunk, **keys):
        chunk.last = self.now()
        chunk.hits = keys.get('hits', 0)

    def merge(self, chunk, **keys):
        chunk.last = self.now()

    def matched(self, chunks):
        print('matched', [str(c) for c in chunks])

    def activation(self, chunk):
        return self.scale * (chunk.hits - (self.now() - chunk.last))

    def recalled(self, chunk):
        chunk.hits += 1
        print('recalled', chunk, chunk.hits)


class Tired(ProceduralSubModule):
    def __init__(self, step=1):
        self.step = step

    def create(self, prod, parents=None):
        prod.uses = 0

    def selecting(self, prod):
        print('selecting', prod.name)

    def firing(self, prod):
        prod.uses += self.step

    def reward(self, value):
        print('reward', value)

    def utility(self, prod):
        return -prod.uses

    def below_threshold(self):
        print('below')


class Loud(Buffer):
    def set(self, chunk):
        Buffer.set(self, chunk)
        print('set', self.chunk)


class Chatty(Memory):
    def request(self, pattern, **keys):
        print('asked for', pattern)
        Memory.request(self, pattern, **keys)


class Base(ACTR):
    goal = Loud()
    retrieval = Buffer()
    memory = Chatty(retrieval, latency=0.1)
    recency = Recency(memory, scale=0.5)
    tired = Tired(step=0.75)

    def init():
        memory.add('fact one')
        memory.add('fact two', hits=2)
        goal.set('go')

    def ask(goal='go'):
        memory.request('fact ?')
        goal.set('wait')

    def heard(goal='wait', retrieval='fact ?x', memory='busy:False'):
        print('base heard', x)
        goal.set('go')

    def never(goal='go', retrieval='no'):
        pass


class Derived(Base):
    production_threshold = -1.5

    def __init__(self, word, **keys):
        Base.__init__(self)
        self.word = word
        self.sizes = [1, 2]

    def heard(goal='wait', retrieval='fact ?x', memory='busy:False', self='word:?w'):
        print(w, 'heard', x, len(self.sizes))
        self.reward(0.5)
        retrieval.clear()
        goal.set('go')

    def added(goal='go', utility=0.25):
        memory.add('fact one')
        goal.set('go')


for agent in [Base(), Derived('derived')]:
    agent.run(limit=1.02)
    print([(c.hits, '%.3f' % c.activation, str(c)) for c in agent.memory.dm if hasattr(c, 'activation')])
    del agent.memory.dm[0]
    print(len(agent.memory.dm), [p.uses for p in agent._productions])
