"""What `plume-map` knows: events that are flooded, and the map of where the source may be."""
