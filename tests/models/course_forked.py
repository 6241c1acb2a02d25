# Two productions can follow one situation; utilities and noise decide which, and repetition is over many runs.
# seeds: 1 2 3
import ccm
from ccm import *
from ccm.lib.actr import *


class MyEnvironment(ccm.Model):
    pass


class MyAgent(ACTR):
    focus = Buffer()
    DMbuffer = Buffer()
    DM = Memory(DMbuffer)

    def init():
        DM.add('cue:customer condiment:mustard')
        focus.set('sandwich bread')

    def bread_bottom(focus='sandwich bread'):
        print('I have a piece of bread')
        focus.set('sandwich cheese')

    def cheese(focus='sandwich cheese'):
        print('I have put cheese on it')
        DM.request('cue:customer condiment:?')
        focus.set('sandwich condiment')

    def forked_ham(focus='sandwich cheese'):
        print('I have put ham on it')
        focus.set('sandwich bread_top')

    def condiment(focus='sandwich condiment', DMbuffer='condiment:?c'):
        print('and', c)
        focus.set('sandwich bread_top')

    def bread_top(focus='sandwich bread_top'):
        print('done at %.2f' % self.now())
        focus.set('stop')

    def stop_production(focus='stop'):
        self.stop()


for i in range(4):
    tim = MyAgent()
    subway = MyEnvironment()
    subway.agent = tim
    ccm.log_everything(subway)
    subway.run()
    ccm.finished()
