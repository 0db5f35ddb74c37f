"""Random scenarios with a verdict of their own, one module for each class."""
