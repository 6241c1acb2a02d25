# seeds: 1 2
# rehearsal loop with base level + forgetting, RT printouts of seven decimals, request within request, cancel pending
from python_actr import *
log=log()
class A(ACTR):
    goal=Buffer(); r=Buffer(); r2=Buffer()
    m=Memory(r,latency=0.5,threshold=-0.5,maximum_time=1.3)
    bl=DMBaseLevel(m,limit=0)
    nz=DMNoise(m,noise=0.1,baseNoise=0.3)
    m2=Memory(r2,latency=1.0,threshold=0.2,finst_size=1,finst_time=0.5)
    bl2=DMBaseLevel(m2,decay=0.3,limit=2)
    n=0
    def init():
        for w in ('one','two','three','four'):
            m.add('word:%s'%w)
            m2.add('word:%s len:%d'%(w,len(w)))
        goal.set('go')
    def go(goal='go',m='busy:False',self='n:?k!25'):
        self.n+=1
        m.request('word:?')
        m2.request('len:!3 word:?',require_new=(self.n%2==0))
        goal.set('wait')
    def both(goal='wait',r='word:?w',r2='word:?w'):
        print('both',w)
        m.add('word:?w'); m2.add('word:?w len:%d'%len(w))
        goal.set('go')
    def differ(goal='wait',r='word:?w',r2='word:?v!?w'):
        print('differ',w,v)
        m.add('word:?w')
        goal.set('go')
    def one(goal='wait',r='word:?w',m2='error:True'):
        print('one',w)
        goal.set('go')
    def err(goal='wait',m='error:True'):
        print('err %.4f'%self.now())
        goal.set('go'); m.add('word:two')
    def hurry(goal='wait',r2='word:?v',m='busy:True',utility=-0.1):
        print('hurry',v)
        m.request('word:?v')
        r2.clear()
a=A()
a.run(limit=20)
print(a.n,'%.3f'%a.now())
