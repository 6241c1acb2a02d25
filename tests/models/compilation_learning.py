# seeds: 1 2
# compile + PMNew + noise; compiled rules named
from python_actr import *
class A(ACTR):
    goal=Buffer(); retrieval=Buffer()
    memory=Memory(retrieval,latency=0.1)
    pmc=PMCompile(keep='goal',request='memory.request',retrieve='retrieval')
    pm=PMNew(alpha=0.3)
    noise=PMNoise(noise=0.1)
    def init():
        for i in range(9):
            memory.add('next %d %d'%(i,i+1))
        goal.set('count 0 5 0')
    def ask(goal='count ?a !?a?b ?c'):
        memory.request('next ?a ?')
        goal.set('step ?a ?b ?c')
    def answer(goal='step ?a ?b ?c',retrieval='next ?a ?d'):
        print('%.3f'%self.now(),a,d)
        goal.set('count ?d ?b ?c')
    def reached(goal='count ?a ?a ?c!3'):
        self.reward(5)
        print('%.3f'%self.now(),len(self._productions),sorted('%s %.3f'%x for x in self.get_activation().items()))
        c=int(c)+1
        goal.set('count 0 5 ?c')
    def done(goal='count ?a ?a 3'):
        goal.clear()
a=A()
a.run(limit=30)
print('%.3f'%a.now())
