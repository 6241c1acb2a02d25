# seeds: 1 2
# many simultaneous events of several agents & modules, in three environments one after another, with shared classes
import ccm
from ccm.lib.actr import *
class Clock(ccm.Model):
    t=0
    def start(self):
        while True:
            yield 0.1
            self.t+=1
class Hand(ccm.Model):
    busy=False
    def grab(self,what,who):
        if self.busy: return
        self.busy=True
        yield 0.15
        if getattr(self.parent.parent,what).owner=='none':
            getattr(self.parent.parent,what).owner=who
            print('%.2f %s has %s'%(self.now(),who,what))
        self.busy=False
class A(ACTR):
    goal=Buffer(); r=Buffer()
    m=Memory(r,latency=0.1)
    hand=Hand()
    who='?'
    def init():
        goal.set('want')
        m.add('apple is good'); m.add('pear is good'); m.add('plum is good')
    def think(goal='want',m='busy:False'):
        m.request('? is good',require_new=True)
        goal.set('thinking')
    def take(goal='thinking',r='?what is good',hand='busy:False',m='busy:False'):
        hand.grab(what,self.who)
        r.clear()
        goal.set('taking ?what')
    def taken(goal='taking ?what',hand='busy:False'):
        goal.set('want')
        if top[what].owner!=self.who: print('%.2f %s missed %s'%(self.now(),self.who,what))
    def nothing(goal='thinking',m='error:True'):
        print('%.2f %s gives up'%(self.now(),self.who))
        goal.set('end')
class Garden(ccm.Model):
    clock=Clock()
    apple=ccm.Model(owner='none'); pear=ccm.Model(owner='none'); plum=ccm.Model(owner='none')
for k in range(3):
    g=Garden()
    for n in ['ann','bob','cat'][:k+1]:
        a=A(); a.who=n
        setattr(g,n,a)
    g.run(limit=3)
    print(k,'%.2f'%g.now(),g.clock.t,[o.owner for o in (g.apple,g.pear,g.plum)])
