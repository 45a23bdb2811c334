"""What protects robot and fingers: monitors find events, one pure function decides."""
