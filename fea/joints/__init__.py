"""What do joints bear: a pin along its line of contact in a slot, and what fixes a link to a shaft or another link?

Hands on factors mode by mode, and Hertz's pressure with the stress below it.
"""
