# seeds: 1 2
# agents made by functions and inheritance of three levels; buffers overridden; modules in mixins
from python_actr import *
class Mixin:
    bonus=2
    def helper(self,x): return x+self.bonus
class Base(ACTR):
    goal=Buffer(); r=Buffer()
    m=Memory(r)
    def init():
        goal.set('a 1'); m.add('k 1')
    def step(goal='a ?n!3'):
        print('base step',n)
        goal.set('a %d'%(int(n)+1))
class Mid(Mixin,Base):
    m=Memory(Base.r,latency=0.2)
    extra=Buffer()
    def step(goal='a ?n!3'):
        print('mid step',n,self.helper(int(n)))
        extra.set('seen ?n')
        goal.set('a %d'%(int(n)+1))
    def ask(goal='a 3',extra='seen 2'):
        m.request('k ?'); extra.clear()
class Low(Mid):
    production_time=0.03
    def init():
        goal.set('a 2'); m.add('k 2'); m.add('k 3')
    def got(goal='a 3',r='k ?v'):
        print('low got',v,'%.3f'%self.now())
        r.clear(); goal.clear()
def make(kind,**k):
    a=kind(**k)
    return a
for kind in (Base,Mid,Low):
    a=make(kind,log=True)
    a.run(limit=1)
    print(kind.__name__,'%.3f'%a.now(),a.goal.chunk,len(a._productions))
