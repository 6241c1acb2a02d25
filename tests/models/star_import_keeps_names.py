# What a file names itself before the star import stays its own; the parts are reached by name.
import ccm
log = ccm.log()
finished = 'mine'
from ccm.lib.actr import *


class Agent(ACTR):
    goal = Buffer()
    goal.set('a')

    def first(goal='a'):
        goal.set('b')

    def second(goal='b'):
        goal.clear()


class World(ccm.Model):
    def start(self):
        self.go = ccm.scheduler.Trigger('go')
        yield self.go, 0.3
        print('waited')


agent = Agent(log=log)
agent.run()
log.result = 5
log['x'] = 6
print(finished, ccm.lib.actr.Buffer is Buffer, ccm.pattern.Pattern('a ?x').match(Chunk('a b')))
World().run()
