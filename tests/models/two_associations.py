# seeds: 1 2
# DMAssociate + spreading over two memories with one buffer, fixed and baselevel on adds, merges, and activations printed
from python_actr import *
class A(ACTR):
    goal=Buffer(); r=Buffer(); s=Buffer()
    m=Memory(r,latency=0.2,threshold=-4); n=Memory(s,latency=0.3,threshold=-4)
    ma=DMAssociate(m,goal,weight=0.5,decay=0.4); na=DMAssociate(n,r,weight=1.0)
    mb=DMBaseLevel(m,decay=0.6); nb=DMBaseLevel(n,decay=0.4)
    nf=DMFixed(n,default=0.3); ns=DMSpreading(n,goal,r,s)
    ns.strength=0.9
    ns.weight[r]=0.1
    def init():
        for i,w in enumerate('cat dog cow pig'.split()):
            m.add('animal %s'%w,baselevel=0.1*i); n.add('sound of %s'%w,fixed=0.2*i)
        n.add('sound of cat'); n.add('sound of cow',fixed=1)
        ma.set_association('cat','pig',1.0); na.set_association('dog','dog',0.5)
        goal.set('cat i:0 k:0')
    def one(goal='?w i:?i!9 k:0',m='busy:False',n='busy:False',r=None):
        m.request('animal !?w'); goal.set('?w i:?i k:x')
    def two(goal='?w i:?i k:x',r='animal ?v',n='busy:False',s=None):
        n.request('sound of ?')
        print('%.4f'%self.now(),w,v,' '.join('%.4f'%m.get_activation(c) for c in m.dm),'|',' '.join('%.4f'%n.get_activation(c) for c in n.dm))
    def three(goal='?w i:?i k:x',r='animal ?v',s='sound of ?q',n='busy:False'):
        print('%.4f'%self.now(),q); m.add('animal ?v'); n.add('sound of ?q'); r.clear(); s.clear()
        i=int(i)+1
        goal.set('?v i:?i k:0')
a=A(); a.run(limit=15)
