# Several agents in one market, with a log as a table; prices are asked and answered by calls through the environment.
# seeds: 1 2
import ccm
from ccm.lib.actr import *

log = ccm.log(html=True)


class Trader(ACTR):
    focus = Buffer()
    money = 10
    stock = 0
    imaginal = Buffer()
    production_time_sd = 0.01

    def init():
        focus.set('idle price:none')

    def ask(focus='idle price:none'):
        self.parent.ask(self)
        focus.set('asked price:none')

    def cheap(focus='heard price:?p', self='money:!0'):
        if int(p) <= self.limit:
            self.money -= 1
            self.stock += 1
            self.parent.sold(self, p)
        focus.set('idle price:none')

    def wait(focus='heard price:?p', self='money:!0', utility=-0.1):
        focus.set('idle price:none')

    def broke(focus='heard', self='money:0'):
        print(self.label, 'is broke')
        focus.clear()


class Bold(Trader):
    production_time = 0.07
    limit = 8
    label = 'bold'


class Shy(Trader):
    production_time = 0.11
    limit = 4
    label = 'shy'


class Market(ccm.Model):
    bold = Bold()
    shy = Shy()
    price = 5
    sales = 0

    def ask(self, trader):
        self.sch.add(self.tell, delay=0.1 + self.random.random(), args=[trader])

    def tell(self, trader):
        self.price = 1 + int(self.random.random() * 9)
        trader.focus.set('heard price:%d' % self.price)

    def sold(self, trader, price):
        self.sales += 1
        log.sales = self.sales
        print('%.3f %s buys at %s' % (self.now(), trader.label, price))


market = Market()
ccm.log_everything(market, log)
market.run(limit=15)
print(market.sales, market.bold.stock, market.shy.money)
ccm.finished()
