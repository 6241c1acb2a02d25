# seeds: 1 3
# environment moves many objects; SOSVision with delay whose object goes away during the delay; Models as chunks in memory
import ccm
from ccm.lib.actr import *
class Car(ccm.Model):
    isa='car'
    def __init__(self,speed,colour):
        ccm.Model.__init__(self)
        self.speed=speed; self.colour=colour; self.x=0.0
        self.salience=0.5
    def drive(self):
        while self.x<3:
            yield 0.25
            self.x+=self.speed
        self.visible=False
class Road(ccm.Model):
    def start(self):
        for i,(s,c) in enumerate([(0.5,'red'),(0.75,'blue'),(1.5,'green')]):
            yield 0.4
            car=Car(s,c)
            setattr(self,'car%d'%i,car)
            car.drive()
            car.salience=0.3+0.2*i
        yield 1
        self.car1.salience=1.0
        yield self.car1.drive
        print('%.2f car1 done'%self.now())
class Watcher(ACTR):
    goal=Buffer(); visual=Buffer(); r=Buffer()
    vision=SOSVision(visual,delay=0.12)
    memory=Memory(r)
    def init():
        goal.set('watch')
    def watch(goal='watch',vision='busy:False'):
        vision.request('isa:car x:!0.0 colour:?c')
        goal.set('wait')
    def see(goal='wait',visual='isa:car colour:?c x:?x speed:?s'):
        print('%.3f'%self.now(),c,x,s,visual.chunk)
        memory.add('saw:?c at:?x')
        visual.clear(); goal.set('watch')
    def nothing(goal='wait',vision='error:True'):
        goal.set('watch')
w=Road()
w.watcher=Watcher()
w.run(limit=5)
print(w.watcher.memory.dm)
