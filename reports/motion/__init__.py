"""What does a motion tell, and the envelope of stress over it? One file a feature makes sections; nothing is solved.

Hands on ``motion_sections`` and ``envelope_sections``, and what page, record and tables are made of them.
"""
