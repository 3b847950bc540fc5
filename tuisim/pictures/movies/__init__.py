"""Movies and pictures of a recorded run: which instants they show, how one is drawn, and the files."""
