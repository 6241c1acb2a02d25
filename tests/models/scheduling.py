# The environment schedules calls; agents call the environment by self.parent.parent; sch.add with all its arguments.
from python_actr import *


class Hand(Model):
    grips = 0

    def grip(self, what):
        yield 0.13
        self.grips += 1
        self.parent.parent.taken(what)

    def reach(self):
        self.grip('cup')


class Agent(ACTR):
    goal = Buffer()
    hand = Hand()

    def init():
        goal.set('take')

    def take(goal='take'):
        hand.reach()
        goal.set('wait')

    def taken(goal='wait', top='cup:taken'):
        print('%.3f taken' % self.now())
        goal.set('done')

    def done(goal='done', top='noise:?n!0'):
        print('noise', n)
        goal.clear()
        top.stop()


class Kitchen(Model):
    cup = 'there'
    noise = 0

    def taken(self, what):
        setattr(self, what, 'taken')
        self.sch.add(self.ring, delay=0.2, args=[3])
        self.sch.add(self.ring, delay=0.4, keys={'times': 4})
        self.sch.add(self.late, delay=0.1, priority=-10)
        self.sch.add(self.early, delay=0.1, priority=10)

    def ring(self, times):
        self.noise += times

    def late(self):
        print('late')

    def early(self):
        print('early')


def hello():
    print('func')


kitchen = Kitchen()
kitchen.agent = Agent()
log_everything(kitchen)
kitchen.run(limit=30, func=hello)
print(kitchen.agent.hand.grips, kitchen.noise, '%.3f' % kitchen.now())
kitchen.run(limit=1)
print(kitchen.noise, '%.3f' % kitchen.now())
