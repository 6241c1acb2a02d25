# Keys pressed, presses while busy lost, text written.
import python_actr
from python_actr import ACTR, Buffer, Motor, TextOutput, Model, log_everything


class Agent(ACTR):
    goal = Buffer()
    motor = Motor()
    voice = TextOutput()

    def init():
        goal.set('type:abc at:0')

    def press(goal='type:?w at:?i!3', motor='busy:False'):
        key = w[int(i)]
        voice.write('pressing ' + key)
        motor.press(key)
        i = int(i) + 1
        goal.set('type:?w at:?i')

    def too_soon(goal='type:?w at:?i', motor='busy:True', self='hurried:!?i'):
        motor.press('lost')
        self.hurried = i

    hurried = 'no'

    def last(goal='at:3', motor='busy:False', utility=1):
        voice.write('done')
        goal.clear()


class Computer(Model):
    text = ''

    def key_pressed(self, key):
        self.text += key
        print('%.2f' % self.now(), self.text)


computer = Computer()
computer.agent = Agent()
log_everything(computer)
computer.run()
