"""What a pin bears along its line of contact in a slot, and what bears that fixes a link to a shaft or another link.

Hands on factors mode by mode, and Hertz's pressure with the stress below it.
"""
