// Reading comes here.
