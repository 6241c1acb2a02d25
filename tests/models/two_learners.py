# seeds: 1 2
# PMTD and PMNew together, threshold callable, production_time callable, priorities of functions
from python_actr import *
class A(ACTR):
    goal=Buffer()
    td=PMTD(alpha=0.2,discount=0.7,cost=0.02)
    new=PMNew(alpha=0.15)
    noise=PMNoise(noise=0.3,baseNoise=0.05)
    production_threshold=-0.4
    trial=0
    def init():
        goal.set('s')
    def left(goal='s'):
        goal.set('l')
    def right(goal='s'):
        goal.set('r')
    def straight(goal='s',utility=0.2):
        goal.set('x')
    def l(goal='l'):
        self.reward(1)
        goal.set('e')
    def r(goal='r'):
        self.reward(-0.5)
        goal.set('e')
    def x(goal='x'):
        goal.set('y')
    def y(goal='y'):
        self.reward(2)
        goal.set('e')
    def e(goal='e'):
        self.trial+=1
        print('%.3f'%self.now(),self.trial,' '.join('%s %.4f'%q for q in sorted(self.get_activation().items())))
        goal.set('s')
        if self.trial>15: self.stop()
class W(Model):
    def start(self):
        while True:
            yield 0.5
            self.tick=self.now()
w=W(); w.agent=A()
w.run(limit=12)
print('%.3f'%w.now())
