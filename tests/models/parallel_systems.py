# Parallel production systems inside an agent, each with its own cycle time, sharing the agent's buffers.
from python_actr import *


class Watcher(ProductionSystem):
    production_time = 0.03
    seen = 0

    def note(goal='n:?n', self='last:!?n last:?l'):
        self.last = n
        self.seen += 1
        print('watcher saw', n, 'after', l)

    last = 'nothing'


class Slow(ACTR):
    production_time = 0.17
    state = 'on'

    def init():
        print('slow begins with', goal.chunk)

    def blink(self='state:on', focus='x:?x'):
        self.state = 'off'
        focus.set('x:%d' % (int(x) + 1))

    def blank(self='state:off'):
        self.state = 'on'

    focus = Buffer()

    def setup_focus():
        focus.set('x:1')


class Agent(ACTR):
    goal = Buffer()
    watcher = Watcher()
    slow = Slow()

    def init():
        goal.set('n:0')

    def step(goal='n:?n!7'):
        goal.set('n:%d' % (int(n) + 1))


agent = Agent()
log_everything(agent)
agent.run(limit=1.0)
print(agent.watcher.seen, agent.slow.focus.chunk)
