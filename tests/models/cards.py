# seeds: 1 2
# world with many objects of plain Model, SOSVision over saliences changing, agent picks & removes by parent=None, two viewers
import ccm
from ccm.lib.actr import *
class Table(ccm.Model):
    card_a=ccm.Model(isa='card',value='a',salience=0.9)
    card_b=ccm.Model(isa='card',value='b',salience=0.5)
    card_c=ccm.Model(isa='card',value='c',salience=0.2,visible=False)
    pile=0
    def take(self,value,who):
        for c in self.get_children():
            if getattr(c,'value',None)==value:
                c.value='taken'; c.salience=0.0; self.pile+=1
                print('%.3f'%self.now(),who,'takes',value)
                if self.pile==2: self.card_c.visible=True
class P(ACTR):
    goal=Buffer(); visual=Buffer()
    vision=SOSVision(visual,delay=0.085,delay_sd=0.01)
    who='p'
    def init(): goal.set('look')
    def look(goal='look',vision='busy:False'):
        vision.request('isa:card value:!taken'); goal.set('see')
    def see(goal='see',visual='isa:card value:?v',vision='busy:False'):
        self.parent.take(v,self.who); visual.clear(); goal.set('look')
    def no(goal='see',vision='error:True'):
        goal.set('look')
    def end(goal='look',top='pile:3',utility=5):
        print('%.3f'%self.now(),self.who,'ends'); goal.clear()
class Q(P):
    who='q'; production_time=0.061
t=Table(); t.p=P(); t.q=Q(); t.run(limit=10); print(t.pile)
