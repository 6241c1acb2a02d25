# An activation module made when the memory has chunks already, which python_actr has to be told of by hand.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.5, threshold=-5)

    def init():
        for fact in ('park hippie', 'church hippie', 'bank hippie', 'park captain', 'cave captain', 'store lawyer'):
            memory.add(fact)

    def ask(goal='ask ?who', memory='busy:False'):
        memory.request('? ?who')
        goal.set('answer ?who')

    def answer(goal='answer ?who', retrieval='?where ?who'):
        print('%.3f' % self.now(), who, where)
        goal.set('ask ' + {'hippie': 'captain', 'captain': 'lawyer', 'lawyer': 'nobody', 'nobody': 'hippie'}[who])
        retrieval.clear()

    def nothing(goal='answer ?who', memory='error:True'):
        print('%.3f' % self.now(), who, 'unknown')
        goal.set('done')


agent = Agent()
agent.run(limit=0.1)
spreading = DMSpreading(agent.memory, agent.goal)
spreading.strength = 1.5
for chunk in agent.memory.dm:
    spreading.create(chunk)
agent.memory.add('bank lawyer')
agent.goal.set('ask hippie')
agent.run()
for chunk in agent.memory.dm:
    print(chunk, '%.4f' % agent.memory.get_activation(chunk))
