"""Building blocks shared by several displays."""
