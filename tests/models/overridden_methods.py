# seeds: 1 2
# ACT-R subclass overriding reward, get_activation, run, now; Buffers overriding modify; Memory overriding add & get_activation
from python_actr import *
class LB(Buffer):
    def modify(self,**k):
        print('modify',sorted(k.items()))
        Buffer.modify(self,**k)
    def clear(self):
        print('clear',self.chunk)
        Buffer.clear(self)
class LM(Memory):
    def add(self,chunk,record=None,**k):
        print('add',chunk)
        Memory.add(self,chunk,record=record,**k)
    def get_activation(self,chunk):
        v=Memory.get_activation(self,chunk)
        return v+0.5
    def recall(self,chunk,matches,request_number):
        print('recall',chunk,len(matches))
        for y in Memory.recall(self,chunk,matches,request_number): yield y
class A(ACTR):
    goal=LB(); r=LB()
    m=LM(r,latency=0.1); bl=DMBaseLevel(m); n=DMNoise(m,noise=0.2)
    pm=PMNew()
    total=0
    def reward(self,value):
        self.total+=value
        print('reward',value)
    def run(self,limit=None,func=None):
        print('running')
        ACTR.run(self,limit,func)
    def init():
        goal.set('x:1'); m.add('k 1'); m.add('k 2'); m.add('k 1')
    def a(goal='x:1'):
        goal.modify(x=2); m.request('k ?v')
    def b(goal='x:2',r='k ?v'):
        print('b',v); self.reward(2); goal.clear()
    def c(goal=None,r='k ?v'):
        print('%.4f'%self.now(),m.get_activation(m.dm[0])>0); r.clear()
a=A(); a.run(limit=1); print(a.total,a.now())
