# dm.add inside environment, agent's memory reached from a module, self.parent.goal, agents' attributes in patterns of others
from python_actr import *
class Teacher(Model):
    lesson='none'
    def start(self):
        for i,(q,a) in enumerate([('sky','blue'),('grass','green'),('sun','yellow')]):
            yield 0.5
            self.lesson=q
            self.parent.pupil.memory.add('%s is %s'%(q,a))
            self.parent.pupil.goal.set('think %s'%q)
        yield 2
        print('%.2f end of lesson'%self.now(), self.parent.pupil.known)
class Voice(Model):
    def say(self,*words,**options):
        yield 0.1*len(words)
        print('%.3f'%self.now(),' '.join(words),sorted(options.items()))
        self.parent.known+=1
        self.parent.goal.set('idle')
class Pupil(ACTR):
    goal=Buffer(); retrieval=Buffer()
    memory=Memory(retrieval,latency=0.3)
    voice=Voice()
    known=0
    def init(): goal.set('idle')
    def think(goal='think ?q',teacher='lesson:?q'):
        memory.request('?q is ?')
        goal.set('answer ?q')
    def answer(goal='answer ?q',retrieval='?q is ?a'):
        voice.say(q,'is',a,loud=True)
        goal.set('wait')
    def bored(goal='idle',teacher='lesson:!none',self='known:3'):
        print('%.3f bored'%self.now()); goal.set('sleep')
class School(Model):
    teacher=Teacher(); pupil=Pupil()
s=School(); log_everything(s); s.run(limit=10); print('%.2f'%s.now())
