# seeds: 1 2
# Buffer in an environment, agent nested in an agent's parent, `top` patterns, sub models two deep and production on them
from python_actr import *
class Arm(Model):
    angle=0
    joint=Model(torque=0.5,limit=3)
    def move(self,by):
        for i in range(int(by)):
            yield 0.02
            self.angle+=10
            self.joint.torque=self.joint.torque*1.1
class Robot(Model):
    arm=Arm()
    battery=10
class Ctl(ACTR):
    goal=Buffer()
    robot=Robot()
    def init(): 
        goal.set('move 3')
    def m(goal='move ?k',robot='battery:?b',top='phase:go'):
        print('%.3f'%self.now(),'move',k,b)
        robot.arm.move(k)
        robot.battery-=1
        goal.set('wait ?k')
    def w(goal='wait ?k',robot='arm.angle:30 arm.joint.limit:?l'):
        print('%.3f'%self.now(),'there',k,l,'%.4f'%robot.arm.joint.torque)
        robot.arm.angle=0
        goal.set('move 3')
    def e(goal='move ?k',robot='battery:7',utility=1):
        goal.set('end'); top.phase='over'
    def g(goal='end',top='phase:over kind:?k'):
        print('g',k); goal.clear()
class Lab(Model):
    phase='wait'; kind='lab'
    def start(self):
        yield 0.33
        self.phase='go'
lab=Lab(); lab.inner=Model(); lab.inner.ctl=Ctl()
lab.run(limit=3)
print('%.3f'%lab.now(),lab.inner.ctl.robot.battery)
