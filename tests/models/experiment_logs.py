# seeds: 1 2
# sweep-like: settings at top and loops over parameters with log data; ccm.log to files; log.key with models
import ccm
log=ccm.log(data=True,html=True)
from ccm.lib.actr import *
noise=0.2
trials=4
class S(ACTR):
    goal=Buffer(); r=Buffer()
    m=Memory(r,latency=0.2,threshold=-1)
    n=DMNoise(m,noise=noise)
    bl=DMBaseLevel(m)
    right=0; wrong=0
    def init():
        for q,a in [('two','four'),('three','nine'),('four','sixteen')]:
            m.add('q:%s a:%s'%(q,a))
        m.add('q:two a:five')
        goal.set('ask two 0')
    def ask(goal='ask ?q ?i!4'):
        log.question=q
        m.request('q:?q a:?')
        goal.set('hear ?q ?i')
    def hear(goal='hear ?q ?i',r='q:?q a:?a',m='busy:False'):
        log.answer=a
        log.rt=self.now()
        if a=='four': self.right+=1
        else: self.wrong+=1
        i=int(i)+1
        goal.set('ask ?q ?i')
    def no(goal='hear ?q ?i',m='error:True'):
        log.answer=None
        i=int(i)+1
        goal.set('ask ?q ?i')
for t in range(trials):
    s=S(); log.trial=t
    s.run()
    log.right=s.right; log.wrong=s.wrong
ccm.finished()
