# Logs: of parts, of one's own names, by index, dotted, values of every kind, the summary, and screen off and on.
import python_actr
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    level = 1

    def init():
        goal.set('n:0')

    def step(goal='n:?n!3'):
        log.step = n
        self.log.own = n
        self.log.sub.word = 'w' + n
        self.log['index'] = int(n) / 2
        self.log['index'].more = [n, 1]
        self.log._ = 'the agent itself'
        self.level += 1
        n = int(n) + 1
        goal.set('n:?n')


class World(Model):
    weather = 'rain'


log = log(summary=True)
world = World()
world.run(limit=0)
world.agent = Agent()
log.before = 1
log_everything(world.agent, log['a'])
world.run(limit=0.12)
world.weather = 'sun'
log.tuple = (1, 'two')
log.dict = {'a': 1}
log.none = None
log.flag = True
log.chunk = world.agent.goal.chunk
log.deep.er.and_deeper = 3
log[1][2] = 'twice'
python_actr.log(screen=False)
log.silent = 5
world.run(limit=0.1)
python_actr.log(screen=True)
log.loud = 6
world.run(limit=0.1)
finished()
log.after = 7
second = Agent(log=True)
second.run(limit=0.2)
third = Agent(log=log.third)
third.run(limit=0.2)
