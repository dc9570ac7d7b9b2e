"""What the loads do: beams, frames, solids, stress, verdicts."""
