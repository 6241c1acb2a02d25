# seeds: 1 2
# Trigger objects in productions' actions and generator waiting on memory.changes / buffers' changes / goal.set method
from python_actr import *
from python_actr.scheduler import Trigger
class Watch(Model):
    def start(self):
        while True:
            yield self.parent.goal.set
            print('%.3f set called'%self.now(),self.parent.goal.chunk)
class Watch2(Model):
    def start(self):
        while True:
            yield self.parent.memory.changes, 0.5
            print('%.3f memory changed or 0.5'%self.now(),self.parent.memory.busy)
class Bell(Model):
    rung=None
    def ring(self):
        self.sch.trigger(self.rung,priority=5)
    def start(self):
        self.rung=Trigger("rung")
        while True:
            yield self.rung
            print('%.3f ring'%self.now())
class A(ACTR):
    goal=Buffer(); r=Buffer()
    memory=Memory(r,latency=0.3)
    bell=Bell()
    w=Watch(); w2=Watch2()
    def init():
        goal.set('a 0'); memory.add('n 0'); memory.add('n 1')
    def p(goal='a ?n!4',memory='busy:False'):
        memory.request('n ?')
        goal.set('b ?n')
    def q(goal='b ?n',r='n ?k',memory='busy:False'):
        bell.ring(); r.clear()
        n=int(n)+1
        goal.set('a ?n')
a=A()
a.run(limit=4)
