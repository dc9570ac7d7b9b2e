"""What shapes a link, whatever its kind of part: pins, ends, holes, eyes and sections, and the rules that all obey.

Hands on ``Body``, ``Section`` and ``PartKind``, from which kinds of parts derive.
"""
