// Surfaces come here.
