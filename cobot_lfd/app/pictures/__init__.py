"""What people look at: pictures with what was seen and planned in them, plots and videos."""
