"""Who does what. Until the studio listens beyond loopback there is one account, the local one."""
