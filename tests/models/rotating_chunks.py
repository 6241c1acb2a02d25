# seeds: 1 2
# random models: many productions over three buffers with shared variables, random noise & times
from python_actr import *
import random
class A(ACTR):
    g=Buffer(); h=Buffer(); k=Buffer(); r=Buffer()
    m=Memory(r,latency=0.05,threshold=-3)
    bl=DMBaseLevel(m); sp=DMSpreading(m,g,h)
    sp.strength=1.1; sp.weight[g]=0.4; sp.weight[h]=0.2
    nz=PMNoise(noise=0.3); pm=PMNew(alpha=0.3)
    def init():
        g.set('a b'); h.set('b c'); k.set('c a')
        for x in 'abc':
            for y in 'abc': m.add('%s %s'%(x,y))
    def rot(g='?x ?y',h='?y ?z',k='?z ?w'):
        g.set('?y ?z'); h.set('?z ?w'); k.set('?w ?x'); self.reward(0.1)
    def ask(g='?x ?y!?x',m='busy:False',r=None):
        m.request('?x ?')
    def use(r='?x ?y',g='?x ?z!?y',m='busy:False'):
        print('%.3f'%self.now(),'use',x,y,z); g.set('?y ?x'); r.clear(); self.reward(1)
    def use2(r='?x ?y',h='?p ?y',m='busy:False'):
        print('%.3f'%self.now(),'use2',x,y,p); h.set('?x ?p'); r.clear(); m.add('?p ?x')
    def mix(g='?x ?y',k='!?x ?y!?x'):
        k.set('?y ?x')
    def jump(h='?x ?x',k='?a !?a'):
        h.set('?a ?x')
    def same(g='?x ?x'):
        g.set('a b'); self.reward(-0.5)
    def cl(r='? ?',m='busy:False',utility=-0.1):
        r.clear()
a=A(); log_everything(a); a.run(limit=12)
print(sorted('%s %.5f'%i for i in a.get_activation().items()))
print(len(a.m.dm),a.g.chunk,a.h.chunk,a.k.chunk)
