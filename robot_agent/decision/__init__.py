"""Decision algorithms: where is the source? One file each."""
