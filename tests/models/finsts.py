# require_new, the number of finsts and how long they last.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.123, finst_size=2, finst_time=0.9)
    dm_f = DMFixed(memory)

    def init():
        for n, name in enumerate(['ann', 'ben', 'cyd', 'dan']):
            memory.add('kind:person name:%s' % name, fixed=4 - n)
        goal.set('list 0')

    def ask(goal='list ?n!9'):
        memory.request('kind:person', require_new=True)
        goal.set('heard ?n')

    def heard(goal='heard ?n', retrieval='name:?who', memory='busy:False'):
        print(n, who, [str(c) for c in memory.finst.obj])
        goal.set('list %d' % (int(n) + 1))
        retrieval.clear()

    def none_left(goal='heard ?n', memory='error:True'):
        print(n, 'none left')
        goal.set('list %d' % (int(n) + 1))


agent = Agent()
agent.run(limit=0)
log_everything(agent.goal, log().goal)
agent.run(limit=6)
