# seeds: 1 2
# production utilities with PGC set/lock, mixed rewards, and all PMs printed
from python_actr import *
log=log()
class A(ACTR):
    goal=Buffer()
    pm=PMPGCMixedWeighted(goal=15)
    noise=PMNoise(noise=0.5,baseNoise=0.1)
    def init():


        goal.set('play 0')
    def hit(goal='play ?n'):
        goal.set('reward hit ?n')
    def stay(goal='play ?n'):
        goal.set('reward stay ?n')
    def fold(goal='play ?n',utility=5):
        goal.set('reward fold ?n')
    def reward_hit(goal='reward hit ?n'):
        self.reward(0.7 if int(n)%2 else -0.25)
        goal.set('next ?n')
    def reward_stay(goal='reward stay ?n'):
        self.success()
        goal.set('next ?n')
    def reward_fold(goal='reward fold ?n'):
        self.failure()
        goal.set('next ?n')
    def next(goal='next ?n!20'):
        n=int(n)+1
        print(n,['%s %.4f'%x for x in sorted(self.get_activation().items())])
        goal.set('play ?n')
    def end(goal='next 20'):
        print(self.get_activation('hit'),self.get_activation('stay'))
        self.stop()
for cls in (PMPGC,PMPGCSuccessWeighted,PMPGCMixedWeighted):
    class B(A):
        pm=cls(goal=12)
    b=B()
    log_everything(b)
    b.run()
    print('%.3f'%b.now())
