# yields of all kinds in start, with triggers, nested generators, exceptions inside, and several waiters
from python_actr import *
from python_actr.scheduler import Trigger
import python_actr
class Light(Model):
    def start(self):
        self.colour='red'
        self.on=Trigger('on'); self.end=Trigger('end')
        self.cycle()
        self.watch('a')
        self.watch('b')
        self.both()
        yield 3.5
        self.sch.trigger(self.end)
        yield Trigger('never')
        print('not here')
    def cycle(self):
        for i in range(4):
            yield 0.5
            self.colour='green'
            self.sch.trigger(self.on)
            yield 0.25,0.1
            self.colour='red'
            yield self.pause, 5
    def pause(self,t=0.3):
        print('%.2f pause %s'%(self.now(),t))
        yield t
        return
    def watch(self,name):
        try:
            while True:
                yield self.on
                print('%.2f %s sees %s'%(self.now(),name,self.colour))
                self.pause(0.2)
                yield self.pause
                print('%.2f %s after'%(self.now(),name))
        finally:
            pass
    def both(self):
        yield self.end,self.on
        print('%.2f both 1'%self.now())
        yield self.end
        print('%.2f both 2'%self.now())
        x=self.pause(0.01)
        yield x
        print('%.2f both 3'%self.now(), x is not None)
        yield [self.pause(0.4), 0.1]
        print('%.2f both 4'%self.now())
        yield 0
        yield 0.0
        print('%.2f both 5'%self.now())
m=Light()
m.run(limit=2)
print('%.2f'%m.now())
m.run()
print('%.2f'%m.now())
