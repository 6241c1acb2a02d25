# pattern oddities through productions
from python_actr import *
def test(chunk,**pats):
    class T(ACTR):
        goal=Buffer(); other=Buffer(); done=False
        def init():
            goal.set(self.c); other.set('?' if False else 'p q r:7')
        def a(): pass
    return T
class P(ACTR):
    goal=Buffer(); other=Buffer()
    cases=['a b c','a a','b a:1','x:1.0','x:1','1 2 3','k:None','None','a!b','x:a:b','a,b c','é ü','A','a? b','!a']
    i=0
    def init():
        other.set('p q r:7')
        goal.set(self.cases[0])
    def two(goal='?x ?x'): print('same',x); self.next()
    def diff(goal='?x ?y!?x ?z!?x!?y'): print('diff',x,y,z); self.next()
    def xv(goal='x:?v',other='p ?q r:!?v'): print('x',v,q); self.next()
    def none(goal='k:None'): print('k None'); self.next()
    def none2(goal='?n!a!b!1!A'): print('pos',n); self.next()
    def one(goal='1:?y!a!2!b',other='? ?y'): print('one',y); self.next()
    def cc(goal='2:3 0:?a'): print('cc',a); self.next()
    def ba(goal='b ? a:?z'): print('ba',z); self.next()
    def ba2(goal='b a:?z'): print('ba2',z); self.next()
    def cap(goal='A'): print('cap'); self.next()
    def next(self):
        self.i+=1
        if self.i<len(self.cases): self.goal.set(self.cases[self.i])
        else: self.stop()
    def skip(goal='',utility=-1): print('skip',goal.chunk); self.next()
p=P(); p.run(limit=3)
print(p.i,'%.2f'%p.now())
