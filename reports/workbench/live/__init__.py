"""What does the page show of a case? Pose and forces, verdicts by hand and by solids, from processes of their own."""
