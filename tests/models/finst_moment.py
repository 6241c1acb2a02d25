"""What looks at the very moment at which a mark expires: before that event or after it, as the queue has them."""

from python_actr import *


class Look(Model):
    def after(self, time, priority):
        yield {'delay': time, 'priority': priority}
        print(self.now(), priority, self.parent.memory.finst.contains(Chunk('a 1')))


class Agent(ACTR):
    retrieval = Buffer()
    memory = Memory(retrieval, finst_time=1.0)
    look = Look()

    def init():
        memory.add('a 1')
        look.after(1.0, 5)
        memory.request('a ?')
        look.after(1.0, -5)
        look.after(0.75, 0)


agent = Agent()
agent.run(limit=1.5)
