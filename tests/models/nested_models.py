# Models in models: class attributes become each instance's own; children, names by item, changes seen far below.
import python_actr


class Wheel(python_actr.Model):
    turns = 0

    def turn(self, n=1):
        self.turns += n


class Car(python_actr.Model):
    left = Wheel()
    right = Wheel()
    fuel = 3

    def drive(self):
        if self.fuel > 0:
            self.fuel -= 1
            self.left.turn()
            self.right.turn(2)


class Driver(python_actr.ACTR):
    goal = python_actr.Buffer()

    def init():
        goal.set('drive')

    def go(goal='drive', car='fuel:!0 fuel:?f'):
        print('fuel', f, car['left']['turns'])
        car.drive()

    def stuck(goal='drive', car='fuel:0 right.turns:?t'):
        print('stuck after', t)
        goal.clear()
        other.fuel = 5


class Street(python_actr.Model):
    car = Car()
    other = Car()

    def start(self):
        yield self.other.left.turn
        print('somebody turned the other wheel')


street = Street()
street.driver = Driver()
python_actr.log_everything(street)
street.run()
street.other.drive()
street.run()
print(street.car.left.turns, street.other.left.turns, Car.fuel, street['other']['fuel'])
