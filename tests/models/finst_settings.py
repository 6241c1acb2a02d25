# finsts and require_new under many settings
from python_actr import *
for size in (0,1,2,10):
    for time in (0.1,0.5,100):
        class A(ACTR):
            goal=Buffer(); r=Buffer()
            m=Memory(r,latency=0.05,finst_size=size,finst_time=time)
            fx=DMFixed(m)
            def init():
                for i,w in enumerate('abcd'): m.add('w %s'%w,fixed=0.1*i)
                goal.set('n:0 x:0')
            def ask(goal='n:?n!9 x:0',m='busy:False',r=None):
                m.request('w ?',require_new=True); goal.set('s n:?n x:1')
            def got(goal='s n:?n',r='w ?x',m='busy:False'):
                self.seen.append(x); n=int(n)+1; r.clear(); goal.set('n:?n x:0')
            def no(goal='s n:?n',m='error:True'):
                self.seen.append('-'); n=int(n)+1; goal.set('n:?n x:0')
            seen=[]
        a=A(); a.run(limit=5); print(size,time,''.join(a.seen))
