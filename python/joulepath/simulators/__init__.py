"""Simulators of other makers that drive the motions of logs; each needs its own package."""
