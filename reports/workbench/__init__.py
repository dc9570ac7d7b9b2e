"""The page to work in: ``alula open`` serves a case to the browser of this machine, with live answers."""
