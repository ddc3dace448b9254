"""`./roomba status`: what a robot does, as its page's server tells it."""
