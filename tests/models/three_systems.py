# Timer-free clock productions: production_time set per firing, zero-time production, match delay, simultaneous fire of 3 systems
from python_actr import *
class S1(ProductionSystem):
    production_time=0.05
    b=Buffer()
    def init(): b.set('0')
    def p(b='?n!6'):
        print('%.3f S1'%self.now(),n); b.set(str(int(n)+1)); self.production_time=0.01*int(n)+0.02
class S2(ProductionSystem):
    production_time=0.05
    production_match_delay=0
    def p(b2='?n!6'):
        print('%.3f S2'%self.now(),n); b2.set(str(int(n)+1))
class A(ACTR):
    b2=Buffer(); goal=Buffer()
    s1=S1(); s2=S2()
    production_time=0.025
    def init(): b2.set('0'); goal.set('0')
    def p(goal='?n!10'):
        print('%.3f A'%self.now(),n); goal.set(str(int(n)+1))
    def q(goal='10',b2='6',s1='b.0:6'):
        print('%.3f all'%self.now()); goal.clear(); 
a=A(); log_everything(a); a.run(limit=2); print('%.3f'%a.now())
