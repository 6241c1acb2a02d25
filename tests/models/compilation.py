# seeds: 1 2
# Production compilation with utility learning: the log shows what fires, and when rules of its own making come in.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.1)
    compiling = PMCompile(keep='goal', request='memory.request', retrieve='retrieval')
    learning = PMNew(alpha=0.3)
    noise = PMNoise(noise=0.05)

    def init():
        for pair in ['one two', 'two three', 'three four', 'four one']:
            memory.add('next ' + pair)
        goal.set('now:one phase:ask')

    def ask(goal='now:?n phase:ask'):
        memory.request('next ?n ?')
        goal.modify(phase='hear')

    def hear(goal='now:?n phase:hear', retrieval='next ?n ?x'):
        goal.set('now:?x phase:ask')
        self.reward(2)


agent = Agent()
log_everything(agent)
agent.run(limit=3)
for p in agent._productions:
    print(p.name, '%.3f' % p.util)
