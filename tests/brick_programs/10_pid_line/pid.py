class PID:
    """Plain PID with a clamp on the integral."""

    def __init__(self, kp, ki, kd, target, limit=100, ilimit=400):
        self.kp, self.ki, self.kd = kp, ki, kd
        self.target = target
        self.limit = limit
        self.ilimit = ilimit
        self.integral = 0
        self.last = None

    def step(self, value):
        error = self.target - value
        self.integral = max(-self.ilimit, min(self.ilimit, self.integral + error))
        d = 0 if self.last is None else error - self.last
        self.last = error
        out = self.kp * error + self.ki * self.integral + self.kd * d
        return max(-self.limit, min(self.limit, out))
