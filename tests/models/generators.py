# Generator methods, and all they can yield.
from python_actr import *
from python_actr.scheduler import Trigger


class Machine(Model):
    state = 'off'
    count = 0

    def quick(self, what):
        print('%.2f quick %s' % (self.now(), what))

    def slow(self, seconds):
        print('%.2f slow begins' % self.now())
        yield seconds
        print('%.2f slow ends' % self.now())

    def work(self):
        yield 1
        self.state = 'on'
        yield self.slow(0.5)
        print('%.2f after slow' % self.now())
        yield dict(delay=0.25, priority=-5)
        self.count += 1
        print('%.2f after dict' % self.now())
        yield 0
        self.quick('from work')

    def waits_for_method(self):
        yield self.quick
        print('%.2f quick has been called' % self.now())

    def waits_for_slow(self):
        yield self.slow
        print('%.2f slow has ended' % self.now())

    def waits_for_first(self):
        yield 5, self.quick
        print('%.2f first of two' % self.now())
        yield 0.3, self.quick
        print('%.2f time was first' % self.now())

    def waits_for_trigger(self):
        yield self.bell
        print('%.2f bell' % self.now())
        yield 'gong'
        print('%.2f gong' % self.now())

    def waits_for_changes(self):
        for i in range(2):
            yield self.changes
            print('%.2f changed: %s %s' % (self.now(), self.state, self.count))

    def rings(self):
        yield 2.6
        self.sch.trigger(self.bell)
        yield 0.4
        self.count = 10
        yield [0.1, 0.7]
        print('%.2f list' % self.now())

    def start(self):
        self.bell = Trigger('bell')
        self.work()
        self.waits_for_method()
        self.waits_for_slow()
        self.waits_for_first()
        self.waits_for_trigger()
        self.waits_for_changes()
        self.rings()
        yield 4
        print('%.2f start goes on' % self.now())
        e = self.slow(0.2)
        yield e
        print('%.2f and ends' % self.now())


machine = Machine()
log_everything(machine)
machine.run()
print('%.2f' % machine.now())
