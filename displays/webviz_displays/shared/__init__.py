"""What several displays share."""
