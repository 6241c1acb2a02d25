# seeds: 1 2
# memory 'partial' argument requests, subclass of Partial with own similarity, several partials in one memory
from python_actr import *
class Dist(Partial):
    def similarity_of(self,a,b):
        return -abs(int(a)-int(b))/10.0
    def match(self,key,a,b):
        try: return self.strength*self.similarity_of(a,b)
        except ValueError: return -5 if a!=b else 0
class A(ACTR):
    goal=Buffer(); r=Buffer()
    m=Memory(r,latency=0.3,threshold=-2)
    nz=DMNoise(m,noise=0.1)
    part=Dist(m,strength=1.5,limit=-3)
    def init():
        for i in range(0,30,3): m.add('num %d sq:%d'%(i,i*i))
        goal.set('ask 4')
    def ask(goal='ask ?n!44'):
        m.request('num ?n')
        goal.set('hear ?n')
    def hear(goal='hear ?n',r='num ?k sq:?s',m='busy:False'):
        print('%.4f'%self.now(),n,k,s); r.clear()
        goal.set('ask %d'%(int(n)+5))
    def no(goal='hear ?n',m='error:True'):
        print('%.4f'%self.now(),n,'none')
        goal.set('ask %d'%(int(n)+5))
a=A(); a.run(limit=30)
m2=a.m
print([str(c) for c in a.m.find_matching_chunks('num ?')][:2])
a.goal.set('x'); a.m.request('num 7',partial=a.part); a.run(limit=2); print(a.r.chunk)
