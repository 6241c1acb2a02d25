# Chunk API and Buffer dunder behaviour from bodies
from python_actr import *
from python_actr.actr.buffer import Chunk
class A(ACTR):
    goal=Buffer(); b=Buffer()
    def init():
        goal.set('x:1 y:2')
    def p(goal='x:?x y:?y'):
        c=goal.chunk
        print(len(goal),goal['x'],goal==c,bool(goal),goal.isEmpty(),b.isEmpty(),len(b) if not b.isEmpty() else 'empty')
        b.set(goal.chunk)
        b.modify(x='9')
        print(goal.chunk,b.chunk)
        b.set(dict(goal.chunk))
        print(b.chunk,sorted(b.chunk.items()),'x' in b.chunk,list(b.chunk))
        b.set('?x ?y three:?x')
        print(b.chunk, b[0], b.chunk[1], type(b[0]))
        b.modify(_0='new',three=3)
        print(b.chunk,b['three'],type(b['three']))
        d=b.chunk.copy()
        print(type(d).__name__,sorted(map(str,d)))
        try: b.modify(four=4)
        except Exception as e: print('exception')
        try: b['zzz']
        except Exception as e: print(type(e).__name__)
        goal.clear()
        try: goal.modify(x=1)
        except Exception as e: print('exception')
        b.set('None x a:b:c')
        print(b.chunk)
    def q(goal=None,b='None ? a:?z'):
        print('q',z)
        b.set('1 2 3')
    def r(b='?k ?l ?m',goal=None):
        b.set('?m ?l ?k')
        print(b.chunk)
        goal.set('end ?k')
        self.stop()
a=A(); a.run(limit=1)
print(a.goal.chunk,a.b.chunk,str(a.goal.chunk),repr(a.b.chunk))
