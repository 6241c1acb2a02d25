# seeds: 1 2
# two agents talk through the environment; production_match_delay, callables as production_time
import ccm
from ccm.lib.actr import *
log=ccm.log(html=True)
class Speaker(ACTR):
    goal=Buffer(); heard=Buffer()
    production_match_delay=0.007
    def init():
        goal.set('start')
        self.said=0
    def talk(goal='start',self='said:?s!5'):
        print('%.3f'%self.now(),self.who,'says',s)
        self.said+=1
        self.parent.say(self,'word%d'%self.said)
        goal.set('listen')
    def hear(goal='listen',heard='word ?w from:?f'):
        print('%.3f'%self.now(),self.who,'hears',w,'from',f)
        heard.clear()
        goal.set('start')
    def timeout(goal='listen',heard=None,utility=-0.5):
        pass
    def tired(goal='start',self='said:5'):
        goal.set('sleep')
class Room(ccm.Model):
    def say(self,who,word):
        yield 0.12
        for c in [self.a,self.b]:
            if c is not who:
                c.heard.set('word %s from:%s'%(word,who.who))
class Sp2(Speaker):
    who='two'
    production_time=0.06
    def init():
        goal.set('listen')
        self.said=0
class Sp1(Speaker):
    who='one'
    production_time=0.05
room=Room()
room.a=Sp1()
room.b=Sp2()
ccm.log_everything(room)
room.run(limit=4)
ccm.finished()
