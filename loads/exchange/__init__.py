"""What do other programs' files say of a linkage? A ``Sketch`` of its links, joints and forces, written as a case."""
