# Everything said goes to the screen and to the log; a module of one's own, and start() as a generator.
from python_actr import *


class Ear(Model):
    heard = None

    def start(self):
        for word in ['one', 'two', None, 'three']:
            yield 0.22
            self.heard = word

    def forget(self):
        self.heard = None


class Agent(ACTR):
    goal = Buffer()
    text = TextOutput()
    ear = Ear()

    def listen(ear='heard:?w!None'):
        text.write('heard %s at %.3f' % (w, self.now()))
        ear.forget()

    def start_up():
        text.write('listening')


agent = Agent()
log_everything(agent)
agent.run()
