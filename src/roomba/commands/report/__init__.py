"""`./roomba report`: the runs that were kept, as tables and documents."""
