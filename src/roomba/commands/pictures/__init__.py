"""Pictures for the documents: one file for each subject, all made by ``./roomba pictures``."""
