# seeds: 1 2
# Motor and key presses from two agents, with environment functions and busy checks, log_everything to named logs
import python_actr
from python_actr import *
log=python_actr.log()
class Keyboard(Model):
    keys=''
    last=None
    def key_pressed(self,key):
        self.keys+=str(key); self.last=key
        print('%.3f'%self.now(),'key',key)
class Typist(ACTR):
    goal=Buffer(); motor=Motor()
    text='abc'
    def init(): 
        goal.set('type 0')
    def type(goal='type ?i!3',motor='busy:False'):
        motor.press(self.text[int(i)]); i=int(i)+1; goal.set('type ?i')
    def eager(goal='type ?i!3!0',motor='busy:True',utility=0.1):
        motor.press('!'); goal.set('type ?i pressed:yes') if False else goal.set('rest ?i')
    def rest(goal='rest ?i',motor='busy:False'):
        goal.set('type ?i')
    def done(goal='type 3',motor='busy:False'):
        print('%.3f'%self.now(),self.text); goal.clear()
class T2(Typist):
    text='XYZ'
    production_time=0.06
k=Keyboard(); k.one=Typist(); k.two=T2()
log_everything(k,log)
k.run(limit=6)
print(k.keys,k.last)
