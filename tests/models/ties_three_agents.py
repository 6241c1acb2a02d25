import python_actr
from python_actr import *
log=python_actr.log()
class P(ACTR):
    goal=Buffer(); retrieval=Buffer(); memory=Memory(retrieval)
    def init():
        memory.add('play rock'); goal.set('choose')
    def choose(goal='choose'):
        memory.request('play ?'); goal.set('wait')
    def act(goal='wait', retrieval='play ?x'):
        print('act', me, x); goal.set('choose'); retrieval.clear()
class E(Model): pass
e=E()
e.a=P(); e.b=P(); e.c=P()
e.c.me="C"; e.a.me='A'; e.b.me='B'
log_everything(e)
e.run(limit=1.99)
