# Requests, failures, latency, threshold, maximum time, busy, and a request that cancels another.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.5, threshold=-1, maximum_time=2.0)
    fixed = DMFixed(memory, default=0.5)

    def init():
        memory.add('capital France Paris')
        memory.add('capital Spain Madrid', fixed=-0.5)
        memory.add('capital Malta Valletta', fixed=-3)
        memory.add('capital:yes of:Peru name:Lima', fixed=2)
        goal.set('ask France')

    def ask(goal='ask ?c'):
        memory.request('capital ?c ?')
        goal.set('wait ?c')

    def waiting(goal='wait ?c', memory='busy:True', self='patience:!0'):
        self.patience -= 1

    patience = 3

    def got(goal='wait ?c', retrieval='capital ?c ?x', memory='busy:False', utility=1):
        print(c, 'is', x, '%.3f' % self.now())
        goal.set('ask Spain' if c == 'France' else 'ask Malta')
        retrieval.clear()

    def failed(goal='wait ?c', memory='error:True', utility=1):
        print('failed', c, '%.3f' % self.now())
        goal.set('named')

    def named(goal='named', memory='error:True'):
        memory.request('of:Peru')
        goal.set('named wait')

    def cancel(goal='named wait', memory='busy:True error:False'):
        memory.request('capital France ?')
        memory.request('of:Peru name:?who')
        goal.set('got name')

    def got_name(goal='got name', retrieval='name:?n'):
        print('name', n, '%.3f' % self.now())
        memory.request('none of these')
        goal.set('last')

    def added(goal='last', retrieval='name:?n'):
        memory.add('new thing')
        goal.set('very last')

    def very_last(goal='very last', memory='error:False', retrieval=None):
        print('add resets error', len(memory.dm))

    def very_last_error(goal='very last', memory='error:True', retrieval=None):
        print('error', len(memory.dm))
        goal.clear()
        memory.clear()
        print(len(memory.dm))


agent = Agent()
log_everything(agent)
agent.run(limit=30)
