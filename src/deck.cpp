// The deck comes here.
