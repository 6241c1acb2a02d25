# logs: the old text format for everything, log_everything twice, models as attributes, buffers holding models, long names
import ccm
from ccm.lib.actr import *
log=ccm.log()
class Thing(ccm.Model):
    a=1
    b='two words'
    c=3.0
    d=None
    e=[1]
    f={'x':1}
    g=True
class A(ACTR):
    goal=Buffer(); r=Buffer(); thing=Thing()
    m=Memory(r,latency=0.123456)
    text=TextOutput()
    def init():
        goal.set('a'); m.add('x y')
        text.write('hello')
    def p(goal='a',thing='a:1'):
        thing.a=2; thing.c=thing.c/3; thing.new='n'; thing.e=[2,3]; thing.g=False; thing.d=(1,)
        thing.a=2
        m.request('x ?'); goal.set('b')
        text.write('p %s'%self.now())
    def q(goal='b',r='x ?y'):
        text.write(y)
        pass
        pass
        goal.set(thing); goal.clear()
a=A()
env=ccm.Model(); env.agent=a
ccm.log_everything(env); ccm.log_everything(a,log.second)
env.run()
ccm.finished()
