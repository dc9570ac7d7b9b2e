"""What do the tests of a level say? Their sections, the page of a level, and the folder with a report of each."""
